// SPDX-License-Identifier: Apache-2.0
// Reading regress.yaml: tables, and what only the whole file can tell.
#include "document.h"
#include "params_read.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/scene/regression.h>

typedef struct regression_def
{
    ty_regression_limits limits;
    ty_param_list cases;
} regression_def;

static void limits_default(void* def)
{
    *(ty_regression_limits*)def = (ty_regression_limits){.rmse = TY_REGRESSION_UNJUDGED,
                                                         .relmse = TY_REGRESSION_UNJUDGED,
                                                         .trelmse = TY_REGRESSION_UNJUDGED,
                                                         .mae = TY_REGRESSION_UNJUDGED,
                                                         .psnr = 0.0f,
                                                         .max = TY_REGRESSION_UNJUDGED,
                                                         .flip = TY_REGRESSION_UNJUDGED,
                                                         .hdrflip = TY_REGRESSION_UNJUDGED};
}

static void case_default(void* def)
{
    *(ty_regression_case*)def = (ty_regression_case){0};
    limits_default(&((ty_regression_case*)def)->limits);
}

static void regression_default(void* def)
{
    *(regression_def*)def = (regression_def){0};
    limits_default(&((regression_def*)def)->limits);
}

#define LIMIT(name, help)                                                                                              \
    {                                                                                                                  \
#name, TY_PARAM_FLOAT, "", 0, 1e30, NULL, NULL, offsetof(ty_regression_limits, name), help, false              \
    }

static const ty_param limit_rows[] = {
    LIMIT(rmse, "root of the mean squared difference"),
    LIMIT(relmse, "mean of the squared difference over the squared reference plus .01"),
    LIMIT(trelmse, "the same without the worst .1 % of the pixels"),
    LIMIT(mae, "mean of the difference's magnitude"),
    LIMIT(psnr, "decibels that must be reached; the peak is the reference's largest value"),
    LIMIT(max, "largest difference"),
    LIMIT(flip, "mean LDR-FLIP of the developed pictures, 0..1"),
    LIMIT(hdrflip, "mean HDR-FLIP of the linear pictures, 0..1"),
};

static const ty_param_table limits_table = {
    "regress.limits",
    "How far a picture may be from its reference; what is not written is not judged.",
    sizeof(ty_regression_limits),
    limits_default,
    limit_rows,
    TY_PARAM_COUNT(limit_rows)};

static const ty_param case_rows[] = {
    {"name", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_regression_case, name),
     "letters, digits, _ and -; for --only, reports, and the reference's name", true},
    {"scene", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_regression_case, scene),
     "scene file or folder, from this file's folder", true},
    {"reference", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_regression_case, reference),
     "picture to compare with, .exr or .png (if not written: NAME.exr); made by --update", false},
    {"set", TY_PARAM_STRINGS, "", 0, 0, NULL, NULL, offsetof(ty_regression_case, set),
     "overrides as for --set: 'film.size=[96, 54]'", false},
    {"define", TY_PARAM_STRINGS, "", 0, 0, NULL, NULL, offsetof(ty_regression_case, define),
     "variables as for -D: 'moisture=0.3'", false},
    {"layers", TY_PARAM_STRINGS, "", 0, 0, NULL, NULL, offsetof(ty_regression_case, layers),
     "what is rendered and compared: beauty (default), A, Z, N, P, albedo", false},
    {"limits", TY_PARAM_GROUP, "", 0, 0, NULL, &limits_table, offsetof(ty_regression_case, limits),
     "of this case; those of the file where it says nothing", false},
};

static const ty_param_table case_table = {
    "regress.case",           "A scene and its reference picture.", sizeof(ty_regression_case), case_default, case_rows,
    TY_PARAM_COUNT(case_rows)};

static const ty_param regression_rows[] = {
    {"limits", TY_PARAM_GROUP, "", 0, 0, NULL, &limits_table, offsetof(regression_def, limits), "of every case", false},
    {"cases", TY_PARAM_LIST, "", 0, 0, NULL, &case_table, offsetof(regression_def, cases), "what is rendered", true},
};

static const ty_param_table regression_table = {"regress",
                                                "A file of `tsuya regress`: scenes, reference pictures, limits.",
                                                sizeof(regression_def),
                                                regression_default,
                                                regression_rows,
                                                TY_PARAM_COUNT(regression_rows)};

const ty_param_table* ty_regression_params(void)
{
    return &regression_table;
}

typedef struct regression_reader
{
    ty_reader reader;
    ty_tree tree;
    ty_files files;
    ty_node* root;
    regression_def def;
    bool good;
} regression_reader;

TY_PRINTF(3, 4) static void fault(regression_reader* in, const ty_node* node, const char* format, ...)
{
    char text[512];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    ty_report(in->reader.errors, node->place, TY_BAD_INPUT, "%s", text);
    in->good = false;
}

// Names become file names and words of the command line.
static void check_name(regression_reader* in, const ty_node* node, int index)
{
    const ty_regression_case* cases = in->def.cases.items;
    const char* name = cases[index].name;
    if (strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") != strlen(name) ||
        strlen(name) > 60 || name[0] == '-')
        fault(in, node, "'name': '%.100s' is not made of at most 60 letters, digits, _ and -", name);
    for (int i = 0; i < index; i++)
        if (cases[i].name && strcmp(cases[i].name, name) == 0)
        {
            fault(in, node, "'name': there are two cases '%.100s'", name);
            return;
        }
}

static const char* beside(regression_reader* in, const char* name)
{
    char path[TY_PATH_MAX];
    ty_path_join(in->files.folder, name, path);
    return ty_arena_string(in->reader.arena, path);
}

static void finish_scene(regression_reader* in, const ty_node* node, ty_regression_case* one)
{
    one->scene = beside(in, one->scene);
    if (!ty_file_exists(one->scene) && !ty_folder_exists(one->scene))
        fault(in, node, "'scene': there is no '%.300s'", one->scene);
}

static void finish_reference(regression_reader* in, const ty_node* node, ty_regression_case* one)
{
    const char* name = node ? one->reference : ty_arena_format(in->reader.arena, "%s.exr", one->name);
    const char* extension = ty_path_extension(name);
    one->reference = beside(in, name);
    if (strcmp(extension, "exr") != 0 && strcmp(extension, "png") != 0)
        fault(in, node, "'reference': '%.100s' ends neither in .exr nor in .png", name);
}

static void finish_limits(const ty_regression_limits* common, ty_regression_limits* own)
{
    ty_regression_limits silent;
    limits_default(&silent);
    for (int i = 0; i < TY_PARAM_COUNT(limit_rows); i++)
    {
        size_t at = limit_rows[i].offset;
        float* value = (float*)((char*)own + at);
        if (*value == *(const float*)((const char*)&silent + at))
            *value = *(const float*)((const char*)common + at);
    }
}

static bool judges_something(const ty_regression_limits* limits)
{
    ty_regression_limits silent;
    limits_default(&silent);
    for (int i = 0; i < TY_PARAM_COUNT(limit_rows); i++)
    {
        size_t at = limit_rows[i].offset;
        if (*(const float*)((const char*)limits + at) != *(const float*)((const char*)&silent + at))
            return true;
    }
    return false;
}

static void finish_cases(regression_reader* in)
{
    const ty_node* list = ty_node_get(in->root, "cases");
    ty_regression_case* cases = in->def.cases.items;
    if (in->def.cases.count == 0)
        fault(in, list, "'cases': there are none");
    for (int i = 0; i < in->def.cases.count && in->good; i++)
    {
        const ty_node* node = list->items[i];
        check_name(in, ty_node_get(node, "name"), i);
        finish_scene(in, ty_node_get(node, "scene"), &cases[i]);
        finish_reference(in, ty_node_get(node, "reference"), &cases[i]);
        finish_limits(&in->def.limits, &cases[i].limits);
        if (!judges_something(&cases[i].limits))
            fault(in, node, "nothing is judged: give 'limits' to this case or to the file");
    }
}

static void read_file(regression_reader* in, const char* path)
{
    in->root = ty_document_load(&in->tree, &in->files, path, "", NULL);
    if (!in->root)
        return;
    int before = in->reader.errors->count;
    ty_document_take_version(&in->tree, in->root);
    in->good =
        ty_params_read(&in->reader, in->root, &regression_table, &in->def, NULL) && in->reader.errors->count == before;
    if (in->good)
        finish_cases(in);
}

ty_status ty_regression_load(const char* path, ty_regression* out, ty_error_list* errors)
{
    char file[TY_PATH_MAX], folder[TY_PATH_MAX];
    *out = (ty_regression){0};
    ty_path_join(ty_folder_exists(path) ? path : ".", ty_folder_exists(path) ? "regress.yaml" : path, file);
    const char* shown = strncmp(file, "./", 2) == 0 ? file + 2 : file;
    ty_path_folder(shown, folder);
    ty_arena* arena = ty_arena_create(0); // texts stay where the tree has them
    regression_reader in = {.reader = {.arena = arena, .errors = errors, .files = NULL}, .good = false};
    in.tree = (ty_tree){.arena = arena, .errors = errors};
    in.files = (ty_files){.arena = arena, .errors = errors, .folder = ty_arena_string(arena, folder)};
    in.reader.files = &in.files;
    int first = errors->count;
    read_file(&in, shown);
    if (in.good)
    {
        *out = (ty_regression){arena, ty_arena_string(arena, shown), in.def.cases.items, in.def.cases.count};
        return TY_OK;
    }
    ty_arena_destroy(arena);
    return first < errors->count ? errors->items[first].status : TY_BAD_INPUT;
}

void ty_regression_term(ty_regression* regression)
{
    ty_arena_destroy(regression->arena);
    *regression = (ty_regression){0};
}
