// SPDX-License-Identifier: Apache-2.0
// The field of a host in a folder: the same bits with it and without, what counts as the same host, damage, several
// processes at once.
#include "base/cmocka_all.h"
#include "base/own_folder.h"
#include "roots.h"
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <tsuya/geometry/mesh_file.h>

static ty_roots_recipe recipe_of(int resolution)
{
    ty_roots_recipe recipe = ty_roots_recipe_default();
    recipe.host.resolution = resolution;
    recipe.host.shape.divisions = 48;
    return recipe;
}

static roots_host host_of(const ty_roots_recipe* recipe, const char* cache)
{
    roots_host host;
    ty_error error = {0};
    if (roots_host_init(recipe, cache, NULL, &host, &error) != TY_OK)
        fail_msg("%s", error.text);
    return host;
}

static void assert_same_host(const ty_roots_recipe* recipe, const char* cache)
{
    roots_host plain = host_of(recipe, NULL), kept = host_of(recipe, cache);
    const ty_voxels *a = &plain.field, *b = &kept.field;
    assert_memory_equal(a->size, b->size, sizeof a->size);
    assert_memory_equal(&a->origin, &b->origin, sizeof a->origin);
    assert_true(a->step == b->step);
    size_t count = (size_t)a->size[0] * (size_t)a->size[1] * (size_t)a->size[2];
    assert_memory_equal(a->values, b->values, count * sizeof(float));
    for (int i = 0; i < ROOTS_MASKS; i++)
    {
        assert_int_equal(plain.masks[i] != NULL, kept.masks[i] != NULL);
        if (plain.masks[i])
            assert_memory_equal(plain.masks[i], kept.masks[i], count);
    }
    roots_host_term(&plain);
    roots_host_term(&kept);
}

// The one file of the folder: its path, and what tells that it was written anew.
static ino_t only_file(char path[400])
{
    struct stat info;
    path[0] = '\0';
    assert_int_equal(folder_count(0), 1);
    DIR* folder = opendir(test_folder);
    for (struct dirent* entry; (entry = readdir(folder));)
        if (entry->d_name[0] != '.')
            snprintf(path, 400, "%s/%s", test_folder, entry->d_name);
    closedir(folder);
    assert_int_equal(stat(path, &info), 0);
    return info.st_ino;
}

static void fields_are_kept(void** state)
{
    (void)state;
    char path[400];
    ty_roots_recipe recipe = recipe_of(48);
    assert_same_host(&recipe, test_folder);
    ino_t first = only_file(path);
    assert_non_null(strstr(path, ".field"));
    assert_same_host(&recipe, test_folder);
    recipe.seed.value = 99; // what grows on it
    recipe.count = 3;
    recipe.host.floor_height = 0.01f;
    assert_same_host(&recipe, test_folder);
    assert_true(only_file(path) == first);
    recipe.host.resolution = 32; // another field
    assert_same_host(&recipe, test_folder);
    assert_int_equal(folder_count(0), 2);
    recipe.host.shape.radius = 0.05f; // another host
    assert_same_host(&recipe, test_folder);
    assert_int_equal(folder_count(0), 3);
    recipe.host.kind = TY_ROOTS_HOST_ELLIPSOID; // other places, but as long, and of the same triangles
    for (int i = 0; i < 2; i++)
    {
        recipe.host.shape.size = (ty_vec3){0.04f, 0.03f, i ? 0.02f : 0.03f};
        assert_same_host(&recipe, test_folder);
        assert_int_equal(folder_count(0), 4 + i);
    }
    recipe.host.kind = TY_ROOTS_HOST_SPHERE;
    ty_roots_object_def object = {.kind = TY_ROOTS_HOST_SPHERE, .shape = recipe.host.shape, .scale = {1, 1, 1}};
    recipe.obstacles = (ty_param_list){&object, 1}; // the same ball
    assert_same_host(&recipe, test_folder);
    assert_int_equal(folder_count(0), 5);
}

// A field that was kept without the nearest triangles is made again where something is painted, and then serves both.
static void painted_hosts_are_kept(void** state)
{
    (void)state;
    char path[400], file[200];
    ty_error error;
    ty_roots_recipe recipe = recipe_of(48);
    ty_mesh* mesh;
    assert_int_equal(ty_shape_create(&recipe.host.shape, &mesh, &error), TY_OK);
    float* moss = ty_mesh_add_attribute(mesh, "moss", 1);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        moss[v] = mesh->positions[v].x > 0.0f ? 1.0f : 0.0f;
    snprintf(file, sizeof file, "%s.ply", test_folder);
    assert_int_equal(ty_ply_write(file, mesh, &error), TY_OK);
    ty_mesh_destroy(mesh);
    recipe.host.kind = TY_ROOTS_HOST_MESH;
    recipe.host.mesh = file;
    assert_same_host(&recipe, test_folder);
    ino_t plain = only_file(path);
    recipe.host.avoid.attribute = "moss";
    assert_same_host(&recipe, test_folder);
    ino_t painted = only_file(path);
    assert_true(painted != plain);
    assert_same_host(&recipe, test_folder);
    recipe.host.attract.attribute = "moss";
    assert_same_host(&recipe, test_folder);
    recipe.host.avoid.attribute = recipe.host.attract.attribute = NULL;
    assert_same_host(&recipe, test_folder);
    assert_true(only_file(path) == painted);
    unlink(file);
}

static void byte_turn(const char* path, off_t at)
{
    char byte;
    int fd = open(path, O_RDWR);
    assert_true(fd >= 0);
    if (at < 0)
        at = lseek(fd, at, SEEK_END);
    assert_int_equal(pread(fd, &byte, 1, at), 1);
    byte ^= 0x40;
    assert_int_equal(pwrite(fd, &byte, 1, at), 1);
    close(fd);
}

// Whatever stands there in its place, the host is the same, and the next one finds a good file again.
static void damage_is_made_good(void** state)
{
    (void)state;
    char path[400];
    struct stat info;
    ty_roots_recipe recipe = recipe_of(32);
    assert_same_host(&recipe, test_folder);
    ino_t before = only_file(path);
    assert_int_equal(stat(path, &info), 0);
    const off_t size = info.st_size, lengths[] = {0, 10, 100, size / 2, size - 1};
    for (int i = 0; i < 5; i++)
    {
        assert_int_equal(truncate(path, lengths[i]), 0);
        assert_same_host(&recipe, test_folder);
        ino_t now = only_file(path);
        assert_true(now != before);
        assert_int_equal(stat(path, &info), 0);
        assert_int_equal(info.st_size, size);
        before = now;
    }
    const off_t places[] = {0, 20, 57, 61, 70, 90, 130, 140, size / 2, -1}; // format, key, sizes, hashes, values
    for (int i = 0; i < 10; i++)
    {
        byte_turn(path, places[i]);
        assert_same_host(&recipe, test_folder);
        ino_t now = only_file(path);
        assert_true(now != before);
        before = now;
    }
    // a good field of another host under its name
    char other[400];
    recipe.host.shape.radius = 0.03f;
    assert_int_equal(rename(path, in_folder("kept")), 0);
    assert_same_host(&recipe, test_folder);
    assert_int_equal(unlink(in_folder("kept")), 0);
    (void)only_file(other);
    assert_int_equal(rename(other, path), 0);
    recipe.host.shape.radius = 0.04f;
    assert_same_host(&recipe, test_folder);
}

static void folders_may_be_anything(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_of(32);
    assert_same_host(&recipe, in_folder("nowhere"));
    assert_same_host(&recipe, "/dev/null");
    assert_int_equal(folder_count(0), 0);
}

static void processes_share_a_folder(void** state)
{
    (void)state;
    char path[400];
    ty_roots_recipe recipe = recipe_of(48);
    pid_t children[4];
    for (int i = 0; i < 4; i++)
        if ((children[i] = fork()) == 0)
        {
            for (int round = 0; round < 3; round++)
            {
                roots_host host;
                if (roots_host_init(&recipe, test_folder, NULL, &host, NULL) != TY_OK)
                    _exit(1);
                roots_host_term(&host);
            }
            _exit(0);
        }
    for (int i = 0; i < 4; i++)
    {
        int end;
        assert_int_equal(waitpid(children[i], &end, 0), children[i]);
        assert_int_equal(end, 0);
    }
    (void)only_file(path);
    assert_same_host(&recipe, test_folder);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, folder_setup, folder_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_FOLDER(fields_are_kept),         IN_FOLDER(painted_hosts_are_kept),   IN_FOLDER(damage_is_made_good),
        IN_FOLDER(folders_may_be_anything), IN_FOLDER(processes_share_a_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
