// SPDX-License-Identifier: Apache-2.0
// Frames of a recipe as a film.
#include "video.h"
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

ty_status ty_film_check(const ty_command* command, const char* output, const char* const* endings, ty_output_form form)
{
    bool film = output && ty_video_is_named(output);
    ty_status status =
        ty_output_check(command, film ? "film" : "output", output, endings, film ? TY_OUTPUT_FILE : form);
    if (status == TY_OK && film && !ty_video_available())
        return ty_usage(command, "there is no ffmpeg in PATH; write frames: -o 'OUT.####.png'");
    return status;
}

static ty_status make(const char* recipe, const char* kind, const char* output, const ty_scene_options* options)
{
    ty_error_list errors = {0};
    ty_status status = ty_recipe_make(recipe, kind, output, 0, options, &errors);
    ty_errors_log(&errors);
    return status;
}

static ty_status film_write(const char* pattern, const char* output, double fps, ty_error* error)
{
    ty_frame_numbers found;
    ty_status status = ty_frame_numbers_find(pattern, &found, error);
    if (status != TY_OK)
        return status;
    ty_frame_list list = {found.numbers, found.count};
    status = ty_video_write(output, pattern, &list, fps, error);
    ty_frame_numbers_term(&found);
    return status;
}

ty_status ty_film_make(const char* recipe, const char* kind, const char* output, double fps,
                       const ty_scene_options* options)
{
    static ty_atomic_folder folder; // paths: too large for the stack
    static char pattern[TY_PATH_MAX];
    ty_error error;
    if (!ty_video_is_named(output))
        return make(recipe, kind, output, options);
    char* name = ty_string_format("%s.frames", output);
    ty_status status = ty_atomic_folder_begin(&folder, name, &error);
    ty_free(name);
    if (status != TY_OK)
    {
        ty_log_error(&error);
        return status;
    }
    ty_path_join(folder.temporary, "frame.####.png", pattern);
    status = make(recipe, kind, pattern, options);
    if (status == TY_OK)
    {
        status = film_write(pattern, output, fps, &error);
        if (status != TY_OK)
            ty_log_error(&error);
    }
    ty_atomic_folder_abort(&folder);
    return status;
}
