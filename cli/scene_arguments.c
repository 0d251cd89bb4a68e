// SPDX-License-Identifier: Apache-2.0
// From the command line to the options of a scene's loading.
#include "cli.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/shading/material.h>

void ty_scene_arguments_set(ty_scene_arguments* arguments, const char* format, ...)
{
    TY_ASSERT(arguments->text_count < TY_PARAM_COUNT(arguments->texts));
    char* text = arguments->texts[arguments->text_count++];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof arguments->texts[0], format, list);
    va_end(list);
    arguments->sets[arguments->options.set_count++] = text;
}

ty_status ty_scene_arguments_read(const ty_arguments* arguments, ty_scene_arguments* out)
{
    memset(out, 0, sizeof *out);
    out->options.sets = out->sets;
    out->options.variables = out->variables;
    for (int i = 0; i < arguments->given_count; i++)
    {
        const ty_given* given = &arguments->given[i];
        if (strcmp(given->option->name, "set") == 0)
        {
            out->sets[out->options.set_count++] = given->text;
        }
        if (strcmp(given->option->name, "define") == 0)
        {
            out->variables[out->options.variable_count++] = given->text;
        }
    }
    out->options.ocio = ty_argument_text(arguments, "ocio", NULL);
    out->options.isa = ty_argument_text(arguments, "isa", NULL);
    out->options.cache_folder = ty_argument_text(arguments, "cache", NULL);
    if (ty_argument_has(arguments, "texture-cache"))
    {
        ty_status status = ty_argument_bytes(arguments, "texture-cache", 16e6, 1e15, &out->options.texture_bytes);
        if (status != TY_OK)
        {
            return status;
        }
    }
    out->options.sandbox = ty_argument_has(arguments, "sandbox");
    long threads = 0;
    if (ty_argument_has(arguments, "threads"))
    {
        ty_status status = ty_argument_int(arguments, "threads", 1, 256, &threads);
        if (status != TY_OK)
        {
            return status;
        }
    }
    ty_error error;
    ty_status status = ty_workers_create((int)threads, &out->options.workers, &error);
    if (status != TY_OK)
    {
        ty_log_error(&error);
    }
    return status;
}

void ty_scene_arguments_term(ty_scene_arguments* arguments)
{
    ty_workers_destroy(arguments->options.workers);
    arguments->options.workers = NULL;
}

void ty_errors_log(ty_error_list* errors)
{
    for (int i = 0; i < errors->count; i++)
    {
        ty_log_error(&errors->items[i]);
    }
    if (errors->count > 1)
    {
        ty_log(TY_LOG_ERROR, "%d mistakes", errors->count);
    }
    ty_error_list_term(errors);
}

void ty_scene_warn(const ty_scene* scene)
{
    bool lit = scene->light_count > 0 || scene->render.integrator != TY_INTEGRATOR_PATH;
    for (int i = 0; i < scene->material_count && !lit; i++)
    {
        lit = ty_material_is_emissive(scene->materials[i]);
    }
    if (scene->object_count == 0)
    {
        ty_log(TY_LOG_WARNING, "%s: there are no objects", scene->path);
    }
    if (!lit)
    {
        ty_log(TY_LOG_WARNING, "%s: no lights, and no material emits: the picture will be black", scene->path);
    }
}

ty_status ty_scene_open(const char* path, const ty_scene_options* options, ty_scene** out)
{
    ty_error_list errors = {0};
    ty_status status = ty_scene_load(path, options, out, &errors);
    ty_errors_log(&errors);
    if (status == TY_OK)
    {
        ty_scene_warn(*out);
    }
    return status;
}
