// SPDX-License-Identifier: Apache-2.0
// Any bytes as a scene file, and after a zero byte as --set and -D: no crash, no leak, and the text of a good scene is
// read again as the same scene. Nothing outside an empty folder is opened.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/scene/scene.h>

#define MOST 8       // overrides
#define LONGEST 4096 // bytes: creating a material takes milliseconds, and hundreds of them would look like a hang

int LLVMFuzzerInitialize(int* argc, char*** argv);
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

static char name[] = "/tmp/tsuya_fuzz_XXXXXX/scene.yaml";

int LLVMFuzzerInitialize(int* argc, char*** argv)
{
    (void)argc;
    (void)argv;
    char* slash = strrchr(name, '/');
    *slash = 0;
    if (!mkdtemp(name))
        abort();
    *slash = '/';
    ty_log_set_level(TY_LOG_ERROR);
    return 0;
}

// The recipe of a scene that reads well, or NULL.
static char* read_scene(const void* bytes, size_t size, const ty_scene_options* options)
{
    ty_scene* scene = NULL;
    ty_error_list errors = {0};
    ty_status status = ty_scene_load_memory(name, bytes, size, options, &scene, &errors);
    if ((status == TY_OK) != (scene != NULL) || (status == TY_OK) != (errors.count == 0))
        abort();
    char* recipe = scene ? ty_string_copy(scene->recipe) : NULL;
    ty_scene_destroy(scene);
    ty_error_list_term(&errors);
    return recipe;
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    if (size > LONGEST)
        return 0;
    const char* overrides[2][MOST];
    int counts[2] = {0, 0};
    char* text = ty_alloc(size + 1, 1);
    if (size)
        memcpy(text, data, size);
    size_t scene_size = strnlen(text, size);
    for (size_t i = scene_size + 1; i < size; i += strlen(text + i) + 1)
    {
        int kind = text[i] == '-'; // "-name=value" is a variable
        if (counts[kind] < MOST)
            overrides[kind][counts[kind]++] = text + i + kind;
    }
    ty_scene_options options = {.check_only = true, .sandbox = true};
    char* recipe = read_scene(text, scene_size, &options); // libyaml's own zero bytes end it anyway
    if (recipe)
    {
        char* again = read_scene(recipe, strlen(recipe), &options);
        if (!again || strcmp(recipe, again) != 0)
            abort();
        ty_free(again);
    }
    ty_free(recipe);
    options.sets = overrides[0];
    options.set_count = counts[0];
    options.variables = overrides[1];
    options.variable_count = counts[1];
    options.quick = counts[0] > 1;
    if (counts[0] + counts[1] > 0)
        ty_free(read_scene(text, scene_size, &options));
    ty_free(text);
    return 0;
}
