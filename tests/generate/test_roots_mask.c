// SPDX-License-Identifier: Apache-2.0
// What is painted on a host by textures: the same as on the vertices of a dense mesh, on several objects and instances,
// what is refused, and that roots keep from it.
#include "base/own_folder.h"
#include "roots_grown.h"
#include <tsuya/geometry/aggregate.h>
#include <tsuya/geometry/mesh_file.h>
#include <tsuya/image/exr.h>
#include <tsuya/image/image.h>

enum
{
    WIDTH = 256,
    HEIGHT = 128,
};

static void refused(const ty_roots_recipe* recipe, const char* text)
{
    roots_host host;
    ty_error error = {0};
    assert_int_equal(roots_host_init(recipe, NULL, NULL, &host, &error), TY_BAD_INPUT);
    if (strncmp(error.text, text, strlen(text)) != 0)
        fail_msg("not '%s' but: %s", text, error.text);
}

// Smooth over the seam of a ball's uv, and told from its mirrored and turned selves.
static float painted_at(ty_vec2 uv, int channel)
{
    float wave = 0.5f + 0.3f * ty_sin(2.0f * TY_PI * uv.x) + 0.15f * ty_cos(4.0f * TY_PI * uv.x);
    return channel == 0 ? wave * (0.3f + 0.7f * uv.y) : channel == 1 ? 1.0f - wave : uv.y;
}

// Red, green and blue as above, and alpha as 1 - blue where there is one.
static void picture_write(const char* path, int channels)
{
    ty_error error;
    ty_image image = {.width = WIDTH, .height = HEIGHT, .channels = channels};
    image.pixels = TY_ALLOC(float, WIDTH* HEIGHT* channels);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
        {
            ty_vec2 uv = {((float)x + 0.5f) / WIDTH, 1.0f - ((float)y + 0.5f) / HEIGHT};
            float* pixel = image.pixels + (y * WIDTH + x) * channels;
            for (int c = 0; c < channels; c++)
                pixel[c] = c < 3 ? painted_at(uv, c) : 1.0f - painted_at(uv, 2);
        }
    assert_int_equal(ty_image_write(path, &image, 16, &error), TY_OK);
    ty_image_term(&image);
}

static ty_mesh* ball_create(int divisions)
{
    ty_error error;
    ty_mesh* mesh;
    ty_shape_def def = ty_shape_def_default();
    def.radius = 0.04f;
    def.divisions = divisions;
    assert_int_equal(ty_shape_create(&def, &mesh, &error), TY_OK);
    return mesh;
}

static void mesh_write(const char* path, ty_mesh* mesh)
{
    ty_error error;
    assert_int_equal(ty_ply_write(path, mesh, &error), TY_OK);
    ty_mesh_destroy(mesh);
}

// A dense ball that holds the four channels at its vertices, too.
static void ball_write(const char* path)
{
    static const char* const names[] = {"moss", "ash", "high", "low"};
    ty_mesh* mesh = ball_create(384);
    for (int c = 0; c < 4; c++)
    {
        float* values = ty_mesh_add_attribute(mesh, names[c], 1);
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            values[v] = c < 3 ? painted_at(mesh->uvs[v], c) : 1.0f - painted_at(mesh->uvs[v], 2);
    }
    mesh_write(path, mesh);
}

static ty_roots_recipe recipe_of(const char* path)
{
    ty_roots_recipe recipe = ty_roots_recipe_default();
    recipe.host.kind = TY_ROOTS_HOST_MESH;
    recipe.host.mesh = path;
    recipe.host.resolution = 64;
    recipe.host.floor = false;
    return recipe;
}

// --- values ---

static float largest_difference(const roots_host* a, const roots_host* b)
{
    ty_rng rng = ty_rng_make((ty_seed){5}, 0, 0);
    float most = 0.0f;
    for (int i = 0; i < 4000; i++)
    {
        float turn = ty_rng_range(&rng, 0.0f, 2.0f * TY_PI), y = ty_rng_range(&rng, -0.95f, 0.95f); // no poles
        float side = sqrtf(1.0f - y * y), r = 0.04f * ty_rng_range(&rng, 0.97f, 1.1f);
        ty_vec3 p = {r * side * ty_sin(turn), r * y, r * side * ty_cos(turn)};
        most = ty_max(most, fabsf(roots_host_mask(a, ROOTS_AVOID, p, NULL) - roots_host_mask(b, ROOTS_AVOID, p, NULL)));
    }
    return most;
}

static void textures_are_as_vertices(void** state)
{
    (void)state;
    static const char* const attributes[] = {"moss", "ash", "high", "low"};
    static const char* const channels[] = {"r", "g", "b", "a"};
    char ball[200], picture[200];
    snprintf(ball, sizeof ball, "%s", in_folder("ball.ply"));
    snprintf(picture, sizeof picture, "%s", in_folder("moss.png"));
    ball_write(ball);
    picture_write(picture, 4);
    for (int c = 0; c < 4; c++)
    {
        ty_roots_recipe recipe = recipe_of(ball);
        recipe.host.avoid.attribute = attributes[c];
        roots_host vertices = host_of(&recipe);
        recipe.host.avoid = (ty_roots_mask_def){.texture = picture, .channel = channels[c]};
        roots_host texture = host_of(&recipe);
        float difference = largest_difference(&vertices, &texture);
        print_message("texture and vertices, channel %s: %.4f apart at most\n", channels[c], (double)difference);
        assert_true(difference < 0.004f);
        roots_host_term(&texture);
        recipe.host.avoid.channel = channels[(c + 1) % 4]; // which the picture tells from others
        texture = host_of(&recipe);
        assert_true(largest_difference(&vertices, &texture) > 0.2f);
        roots_host_term(&texture);
        roots_host_term(&vertices);
    }
}

// A further channel of an EXR file, as fills write.
static void further_channels_are_found(void** state)
{
    (void)state;
    char ball[200], picture[200];
    ty_error error;
    snprintf(ball, sizeof ball, "%s", in_folder("ball.ply"));
    snprintf(picture, sizeof picture, "%s", in_folder("fill.exr"));
    ball_write(ball);
    const int window[4] = {0, 0, WIDTH - 1, HEIGHT - 1};
    ty_exr* exr = ty_exr_create(window, window);
    float *y = ty_exr_add_channel(exr, "Y", TY_EXR_FLOAT), *v = ty_exr_add_channel(exr, "v", TY_EXR_FLOAT);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
    {
        ty_vec2 uv = {((float)(i % WIDTH) + 0.5f) / WIDTH, 1.0f - ((float)(i / WIDTH) + 0.5f) / HEIGHT};
        y[i] = painted_at(uv, 0);
        v[i] = painted_at(uv, 1);
    }
    assert_int_equal(ty_exr_write(picture, exr, &error), TY_OK);
    ty_exr_destroy(exr);
    ty_roots_recipe recipe = recipe_of(ball);
    recipe.host.avoid.attribute = "ash";
    roots_host vertices = host_of(&recipe);
    recipe.host.avoid = (ty_roots_mask_def){.texture = picture, .channel = "v"};
    roots_host texture = host_of(&recipe);
    assert_true(largest_difference(&vertices, &texture) < 0.004f);
    roots_host_term(&vertices);
    roots_host_term(&texture);
    recipe.host.avoid.attribute = NULL;
    recipe.host.avoid.channel = "w";
    char expected[300];
    snprintf(expected, sizeof expected, "host.avoid.channel: %s: no channel 'w'; the file has ", picture);
    refused(&recipe, expected);
    recipe.host.avoid.channel = "a";
    snprintf(expected, sizeof expected, "host.avoid.channel: a; '%s' has no alpha", picture);
    refused(&recipe, expected);
}

// --- parts ---

static void parts_have_their_own(void** state)
{
    (void)state;
    char ball[200], picture[200];
    snprintf(ball, sizeof ball, "%s", in_folder("ball.ply"));
    snprintf(picture, sizeof picture, "%s", in_folder("moss.png"));
    ball_write(ball);
    picture_write(picture, 3);
    ty_roots_object_def parts[3];
    for (int i = 0; i < 3; i++)
        parts[i] = (ty_roots_object_def){.kind = TY_ROOTS_HOST_MESH,
                                         .mesh = ball,
                                         .translate = {0.12f * (float)(i - 1), 0.0f, 0.0f},
                                         .scale = {1.0f, 1.0f, 1.0f}};
    parts[2].avoid = (ty_roots_mask_def){.texture = picture, .channel = "b"};
    parts[0].avoid.attribute = "ash";
    ty_roots_recipe recipe = recipe_of(NULL);
    recipe.host.objects = (ty_param_list){parts, 3};
    recipe.host.resolution = 128;
    ty_vec3 top = {0.0f, 0.04f, 0.01f}, shift = {0.12f, 0.0f, 0.0f}, east = {0.0405f, 0.0f, 0.0f};
    roots_host host = host_of(&recipe);
    assert_true(roots_host_mask(&host, ROOTS_AVOID, ty_add(top, shift), NULL) > 0.9f); // blue is v
    assert_true(roots_host_mask(&host, ROOTS_AVOID, ty_sub(shift, top), NULL) < 0.1f);
    assert_true(roots_host_mask(&host, ROOTS_AVOID, top, NULL) == 0.0f); // nothing is said of it
    roots_host_term(&host);
    recipe.host.avoid.attribute = "low"; // 1 - v, where a part says nothing
    host = host_of(&recipe);
    assert_true(roots_host_mask(&host, ROOTS_AVOID, ty_add(top, shift), NULL) > 0.9f);
    assert_true(roots_host_mask(&host, ROOTS_AVOID, top, NULL) < 0.1f);
    assert_true(roots_host_mask(&host, ROOTS_AVOID, ty_neg(top), NULL) > 0.9f);
    float green = roots_host_mask(&host, ROOTS_AVOID, ty_sub(east, shift), NULL);
    roots_host_term(&host);
    recipe = recipe_of(ball);
    recipe.host.avoid.attribute = "ash";
    host = host_of(&recipe);
    assert_float_equal(green, roots_host_mask(&host, ROOTS_AVOID, east, NULL), 0.02f);
    roots_host_term(&host);
}

static void instances_are_painted(void** state)
{
    (void)state;
    char scene[200], picture[200];
    ty_error error;
    snprintf(scene, sizeof scene, "%s", in_folder("balls.glb"));
    snprintf(picture, sizeof picture, "%s", in_folder("moss.png"));
    picture_write(picture, 3);
    ty_aggregate* a = ty_aggregate_create(2, 1);
    a->prototypes[0] = ball_create(128);
    for (uint32_t i = 0; i < 2; i++)
    {
        ty_vec3 place = {i == 0 ? -0.06f : 0.06f, 0.0f, 0.0f}, turn = {i == 0 ? 0.0f : TY_PI, 0.0f, 0.0f};
        a->transforms[i] = ty_affine_from_trs(place, ty_quat_euler(turn), ty_vec3_make(1.0f, 1.0f, 1.0f));
        a->ids[i] = i;
    }
    assert_int_equal(ty_aggregate_write(scene, a, &error), TY_OK);
    ty_aggregate_destroy(a);
    ty_roots_recipe recipe = recipe_of(scene);
    recipe.host.avoid = (ty_roots_mask_def){.texture = picture, .channel = "b"};
    recipe.host.resolution = 128;
    roots_host host = host_of(&recipe);
    const ty_vec3 left = {-0.06f, 0.04f, 0.01f}, right = {0.06f, 0.04f, 0.01f};
    assert_true(roots_host_mask(&host, ROOTS_AVOID, left, NULL) > 0.9f);
    assert_true(roots_host_mask(&host, ROOTS_AVOID, right, NULL) < 0.1f); // it stands on its head
    roots_host_term(&host);
}

// --- what is refused ---

static void wrong_masks_are_refused(void** state)
{
    (void)state;
    char bare[200], ball[200], grey[200];
    snprintf(bare, sizeof bare, "%s", in_folder("bare.ply"));
    snprintf(ball, sizeof ball, "%s", in_folder("ball.ply"));
    snprintf(grey, sizeof grey, "%s", in_folder("grey.png"));
    ty_mesh* mesh = ball_create(32);
    ty_free(mesh->uvs);
    mesh->uvs = NULL;
    mesh_write(bare, mesh);
    mesh_write(ball, ball_create(32));
    picture_write(grey, 1);
    ty_roots_recipe recipe = recipe_of(bare);
    const ty_roots_mask_def mask = {.texture = grey, .channel = "r"};
    recipe.host.attract = mask;
    refused(&recipe, "host.attract.texture: the host has no texture coordinates (uv)");
    recipe.host.mesh = ball;
    roots_host host = host_of(&recipe); // of grey, colours are all the same
    roots_host_term(&host);
    recipe.host.attract.channel = "a";
    refused(&recipe, "host.attract.channel: a; '");
    recipe.host.attract.attribute = "moss";
    refused(&recipe, "host.attract: an attribute or a texture, not both");
    ty_roots_object_def parts[2] = {{.kind = TY_ROOTS_HOST_MESH, .mesh = ball, .scale = {1.0f, 1.0f, 1.0f}},
                                    {.kind = TY_ROOTS_HOST_MESH, .mesh = bare, .scale = {1.0f, 1.0f, 1.0f}}};
    recipe = recipe_of(NULL);
    recipe.host.objects = (ty_param_list){parts, 2};
    recipe.host.avoid = mask;
    refused(&recipe, "host.avoid.texture: objects[1] has no texture coordinates (uv)");
    parts[1].avoid.attribute = "moss";
    refused(&recipe, "host.objects[1].avoid: 'moss'; the host's vertices have curvature_1, curvature_2");
    parts[1].avoid = mask;
    refused(&recipe, "host.objects[1].avoid.texture: the host has no texture coordinates (uv)");
}

// --- roots ---

// How much of the roots' surface about the middle lies on the side of +x.
static float share_east(const ty_roots_recipe* recipe)
{
    ty_mesh* mesh;
    ty_error error;
    assert_int_equal(ty_roots_make(recipe, NULL, &mesh, &error), TY_OK);
    uint32_t right = 0, low = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (mesh->positions[v].y < 0.01f && mesh->positions[v].y > -0.03f)
        {
            low++;
            right += mesh->positions[v].x > 0.0f;
        }
    ty_mesh_destroy(mesh);
    return (float)right / (float)low;
}

static void roots_keep_from_it(void** state)
{
    (void)state;
    char ball[200], picture[200];
    ty_error error;
    snprintf(ball, sizeof ball, "%s", in_folder("ball.ply"));
    snprintf(picture, sizeof picture, "%s", in_folder("half.png"));
    ty_mesh* mesh = ball_create(96);
    ty_vec2 east = {0}; // the uv of the ball's +x
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (mesh->positions[v].x > 0.0399f)
            east = mesh->uvs[v];
    mesh_write(ball, mesh);
    ty_image image = {.width = 64, .height = 32, .channels = 1, .pixels = TY_ALLOC(float, 64 * 32)};
    for (int i = 0; i < 64 * 32; i++)
    {
        float u = ((float)(i % 64) + 0.5f) / 64.0f - east.x;
        image.pixels[i] = 0.5f + 0.5f * ty_cos(2.0f * TY_PI * u);
    }
    assert_int_equal(ty_image_write(picture, &image, 8, &error), TY_OK);
    ty_image_term(&image);
    ty_roots_recipe recipe = recipe_of(ball);
    recipe.tip = recipe.detail = 1.5e-3f;
    recipe.growth.avoid = recipe.growth.attract = 4.0f;
    float plain = share_east(&recipe);
    recipe.host.avoid = (ty_roots_mask_def){.texture = picture, .channel = "r"};
    float avoided = share_east(&recipe);
    recipe.host.attract = recipe.host.avoid;
    recipe.host.avoid.texture = NULL;
    float attracted = share_east(&recipe);
    print_message("surface on the painted side: %.2f; avoided %.2f, sought %.2f\n", (double)plain, (double)avoided,
                  (double)attracted);
    assert_true(plain > 0.35f && plain < 0.65f);
    assert_true(avoided < plain - 0.1f && attracted > plain + 0.1f);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, folder_setup, folder_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_FOLDER(textures_are_as_vertices), IN_FOLDER(further_channels_are_found), IN_FOLDER(parts_have_their_own),
        IN_FOLDER(instances_are_painted),    IN_FOLDER(wrong_masks_are_refused),    IN_FOLDER(roots_keep_from_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
