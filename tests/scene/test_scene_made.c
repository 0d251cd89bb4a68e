// SPDX-License-Identifier: Apache-2.0
// Recipes that make meshes and frames: made once, kept whole, made again when damaged, named where they do not belong.
#include "scene/fixture.h"
#include <dirent.h>
#include <tsuya/geometry/mesh_file.h>

static const char fill[] = "tsuya: 1\nkind: fill\ncells: [24, 16]\nscale: 1\nsteps: 40\n"
                           "drops: { count: 2, radius: 4 }\nloop: { frames: 5, span: 20 }\n";
static const char roots[] = "tsuya: 1\nkind: roots\ncount: 2\nfirst: { spacing: 0 }\ntip: 2\ndetail: 2\n";
static const char scene[] =
    "tsuya: 1\nassets: { fig: { mesh: roots.yaml }, glaze: { frames: fill.yaml, loop: true } }\n"
    "materials: { m: { model: surface, base_color: { texture: glaze } } }\n"
    "objects: [{ mesh: fig, material: m }]\n";

static char cache[TY_PATH_MAX];

static void write_all(void)
{
    fixture_write("fill.yaml", fill);
    fixture_write("roots.yaml", roots);
    fixture_write("scene.yaml", scene);
}

static void must_load(const char* set, int made, int cached)
{
    ty_scene_options options = {.cache_folder = fixture_path("cache", cache), .sets = &set, .set_count = set != NULL};
    ty_status status = fixture_load(&options);
    fixture_print_errors();
    assert_int_equal(status, TY_OK);
    assert_int_equal(fixture_scene->assets_made, made);
    assert_int_equal(fixture_scene->assets_cached, cached);
}

// The entry of the cache with that extension, hidden ones left out; the number of all such.
static int find_kept(const char* extension, char path[TY_PATH_MAX])
{
    DIR* folder = opendir(cache);
    int count = 0;
    assert_non_null(folder);
    for (struct dirent* entry = readdir(folder); entry; entry = readdir(folder))
        if (entry->d_name[0] != '.' && strcmp(ty_path_extension(entry->d_name), extension) == 0)
        {
            ty_path_join(cache, entry->d_name, path);
            ++count;
        }
    closedir(folder);
    return count;
}

static void both_are_made_once(void** state)
{
    (void)state;
    char path[TY_PATH_MAX], frame[TY_PATH_MAX];
    write_all();
    must_load(NULL, 2, 0);
    uint64_t triangles = fixture_scene->triangle_count;
    assert_true(triangles > 100);
    must_load(NULL, 0, 2);
    assert_true(fixture_scene->triangle_count == triangles);
    assert_int_equal(find_kept("frames", path), 1);
    ty_path_join(path, "frame.0005.exr", frame);
    assert_true(ty_file_exists(frame));
    ty_path_join(path, "frame.0006.exr", frame);
    assert_false(ty_file_exists(frame));
    must_load("assets.fig.mesh.count=3", 1, 1); // overrides reach into recipes
    assert_true(fixture_scene->triangle_count > triangles);
    must_load("assets.glaze.frames.loop.frames=6", 1, 1);
    assert_int_equal(find_kept("frames", path), 2);
    assert_int_equal(find_kept("ply", path), 2);
}

static void damage_is_made_good(void** state)
{
    (void)state;
    char path[TY_PATH_MAX], frame[TY_PATH_MAX];
    write_all();
    must_load(NULL, 2, 0);
    assert_int_equal(find_kept("frames", path), 1);
    ty_path_join(path, "frame.0003.exr", frame);
    assert_int_equal(remove(frame), 0);
    must_load(NULL, 1, 1);
    assert_true(ty_file_exists(frame));
    assert_int_equal(find_kept("ply", path), 1);
    assert_int_equal(truncate(path, 2000), 0);
    must_load(NULL, 1, 1);
    // a good mesh, but another one
    char recipe[TY_PATH_MAX];
    const char* set = "count=1";
    ty_scene_options options = {.sets = &set, .set_count = 1};
    fixture_path("roots.yaml", recipe);
    assert_int_equal(ty_recipe_make(recipe, "roots", path, 0, &options, &fixture_errors), TY_OK);
    must_load(NULL, 1, 1);
    must_load(NULL, 0, 2);
}

// A recipe that grows is a sequence in the scene's time; its frames are made once.
static void roots_grow_with_the_scene(void** state)
{
    (void)state;
    fixture_write("grow.yaml", "tsuya: 1\nkind: roots\ncount: 2\nfirst: { spacing: 0 }\ntip: 2\ndetail: 2\n"
                               "grow: { frames: 3 }\n");
    fixture_write("scene.yaml", "tsuya: 1\ntimeline: { end: 3 }\nassets: { fig: { mesh: grow.yaml, fps: 24 } }\n"
                                "materials: { m: { model: surface } }\nobjects: [ { mesh: fig, material: m } ]\n");
    must_load(NULL, 1, 0);
    float reach[3];
    for (int frame = 1; frame <= 3; frame++)
    {
        assert_int_equal(ty_scene_set_frame(fixture_scene, frame, &fixture_errors), TY_OK);
        const ty_mesh* mesh = ty_world_prototype_mesh(fixture_scene->world, 0);
        const ty_mesh_attribute* radius = ty_mesh_find_attribute(mesh, "radius");
        reach[frame - 1] = 0.0f;
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            reach[frame - 1] += radius->values[v];
    }
    assert_true(reach[0] < reach[1] && reach[1] < reach[2]);
    must_load(NULL, 0, 1);
    assert_int_equal(fixture_check("tsuya: 1\ntimeline: { end: 3 }\n"
                                   "assets: { fig: { mesh: grow.yaml, first_frame: 2, last_frame: 4 } }\n"),
                     TY_BAD_INPUT);
    assert_non_null(strstr(fixture_errors.items[0].text, "frames 2 to 4; the recipe makes 1 to 3"));
}

static void meshes_carry_their_recipe(void** state)
{
    (void)state;
    char recipe[TY_PATH_MAX], one[TY_PATH_MAX], two[TY_PATH_MAX];
    ty_scene_options options = {0};
    ty_mesh *mesh = NULL, *again = NULL;
    ty_error error;
    write_all();
    fixture_path("roots.yaml", recipe);
    assert_int_equal(ty_recipe_make(recipe, "roots", fixture_path("one.ply", one), 0, &options, &fixture_errors),
                     TY_OK);
    assert_int_equal(ty_mesh_read(one, &mesh, &error), TY_OK);
    assert_non_null(strstr(mesh->recipe, "kind: roots\n"));
    fixture_write("again.yaml", mesh->recipe);
    fixture_path("again.yaml", recipe);
    assert_int_equal(ty_recipe_make(recipe, NULL, fixture_path("two.ply", two), 0, &options, &fixture_errors), TY_OK);
    assert_int_equal(ty_mesh_read(two, &again, &error), TY_OK);
    assert_string_equal(again->hash, mesh->hash);
    assert_memory_equal(again->positions, mesh->positions, mesh->vertex_count * sizeof(ty_vec3));
    ty_mesh_destroy(mesh);
    ty_mesh_destroy(again);
}

static void places_are_told_apart(void** state)
{
    (void)state;
    ty_scene_options options = {0};
    char recipe[TY_PATH_MAX], out[TY_PATH_MAX];
    write_all();
    fixture_write("scene.yaml", "tsuya: 1\nassets:\n  a: { mesh: fill.yaml }\n  b: { frames: roots.yaml }\n"
                                "  c: { aggregate: roots.yaml }\n");
    assert_int_equal(fixture_load(&options), TY_BAD_INPUT);
    assert_true(fixture_has("fill.yaml", 2, 7, "makes what is named by 'frames'"));
    assert_true(fixture_has("roots.yaml", 2, 7, "'frames': a recipe of kind 'roots' makes what is named by 'mesh'"));
    assert_int_equal(fixture_errors.count, 3);
    fixture_write("scene.yaml",
                  "tsuya: 1\nassets: { glaze: { frames: fill.yaml } }\nmaterials: { m: { model: surface } }\n"
                  "objects: [{ mesh: glaze, material: m }]\n");
    assert_int_equal(fixture_load(&options), TY_BAD_INPUT);
    assert_true(fixture_has("scene.yaml", 4, 19, "is no mesh or shape"));
    fixture_clear();
    fixture_path("fill.yaml", recipe);
    assert_int_equal(ty_recipe_make(recipe, "roots", fixture_path("x.ply", out), 0, &options, &fixture_errors),
                     TY_BAD_INPUT);
    assert_true(fixture_has("fill.yaml", 2, 7, "expected a recipe of kind 'roots', got 'fill'"));
    assert_false(ty_file_exists(out));
}

// A cache that cannot be written costs time, not the picture.
static void no_cache_is_needed(void** state)
{
    (void)state;
    write_all();
    ty_scene_options options = {.cache_folder = "/dev/null/none"};
    ty_status status = fixture_load(&options);
    fixture_print_errors();
    assert_int_equal(status, TY_OK);
    assert_int_equal(fixture_scene->assets_made, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(roots_grow_with_the_scene), FIXTURE_TEST(both_are_made_once),    FIXTURE_TEST(damage_is_made_good),
        FIXTURE_TEST(meshes_carry_their_recipe), FIXTURE_TEST(places_are_told_apart), FIXTURE_TEST(no_cache_is_needed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
