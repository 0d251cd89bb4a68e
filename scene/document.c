// SPDX-License-Identifier: Apache-2.0
// Reading a file with its includes: mappings merged in order, the including file wins.
#include "document.h"
#include <stdlib.h>
#include <string.h>

typedef struct ty_include
{
    const struct ty_include* parent;
    const char* path; // real path, links followed
    int depth;
} ty_include;

typedef struct ty_including
{
    ty_tree* tree;
    ty_files* files;
} ty_including;

static ty_node* load(ty_including* job, const char* path, const char* base, const ty_place* named_at,
                     const ty_include* parent);

// Mappings of `over` go into `under`; anything else of `over` replaces what is there.
static void merge(ty_tree* tree, ty_node* under, const ty_node* over)
{
    for (int i = 0; i < over->count; ++i)
    {
        int index = ty_node_find(under, over->keys[i].text);
        if (index < 0)
            ty_node_add(tree, under, over->keys[i], over->items[i]);
        else if (under->items[index]->kind == TY_NODE_MAP && over->items[i]->kind == TY_NODE_MAP)
            merge(tree, under->items[index], over->items[i]);
        else
        {
            under->items[index] = over->items[i];
            under->keys[index] = over->keys[i];
        }
    }
}

static const char* folder_of(const ty_files* files, const char* name)
{
    if (!strchr(name, '/'))
        return "";
    char folder[TY_PATH_MAX];
    ty_path_folder(name, folder);
    return ty_arena_string(files->arena, folder);
}

static ty_node* include_one(ty_including* job, ty_node* name, const ty_include* self)
{
    const char* path = ty_files_find(job->files, name, "include");
    if (!path)
        return NULL;
    return load(job, path, folder_of(job->files, name->text), &name->place, self);
}

static ty_node* merge_includes(ty_including* job, ty_node* root, const ty_include* self)
{
    ty_node* list = ty_node_get(root, "include");
    if (!list)
        return root;
    ty_node* merged = ty_node_create(job->tree, TY_NODE_MAP, root->place);
    if (!merged)
        return NULL;
    int count = list->kind == TY_NODE_LIST ? list->count : 1;
    for (int i = 0; i < count; ++i)
    {
        ty_node* included = include_one(job, list->kind == TY_NODE_LIST ? list->items[i] : list, self);
        if (included)
            merge(job->tree, merged, included);
        if (job->tree->stopped)
            return NULL;
    }
    merge(job->tree, merged, root);
    ty_node_remove(job->tree, merged, "include");
    return merged;
}

static ty_node* finish(ty_including* job, ty_node* root, const ty_include* self)
{
    char described[80];
    if (root && root->kind != TY_NODE_MAP)
    {
        ty_report(job->tree->errors, root->place, TY_BAD_INPUT, "expected a mapping ('key: value' lines), got %s",
                  ty_node_describe(root, described));
        return NULL;
    }
    return root ? merge_includes(job, root, self) : NULL;
}

static ty_source* make_source(ty_tree* tree, const char* file, const char* base)
{
    ty_source* source = TY_ARENA_ALLOC(tree->arena, ty_source, 1);
    source->file = ty_arena_string(tree->arena, file);
    source->base = ty_arena_string(tree->arena, base);
    return source;
}

// Whether the chain of includes allows one more file; reports.
static bool may_include(ty_including* job, const char* real, const ty_place* named_at, const ty_include* parent)
{
    for (const ty_include* above = parent; above; above = above->parent)
        if (strcmp(above->path, real) == 0)
        {
            ty_report(job->tree->errors, *named_at, TY_BAD_INPUT, "'%s' includes itself", real);
            return false;
        }
    if (parent && parent->depth >= TY_TREE_MAX_INCLUDE_DEPTH)
    {
        ty_report(job->tree->errors, *named_at, TY_BAD_INPUT, "includes nested deeper than %d",
                  TY_TREE_MAX_INCLUDE_DEPTH);
        return false;
    }
    if (++job->tree->files > TY_TREE_MAX_FILES)
    {
        ty_report(job->tree->errors, *named_at, TY_BAD_INPUT, "more than %d files", TY_TREE_MAX_FILES);
        job->tree->stopped = true;
        return false;
    }
    return true;
}

static ty_node* load(ty_including* job, const char* path, const char* base, const ty_place* named_at,
                     const ty_include* parent)
{
    char real[TY_PATH_MAX];
    if (!realpath(path, real))
        strncpy(real, path, sizeof(real) - 1)[sizeof(real) - 1] = 0;
    if (named_at && !may_include(job, real, named_at, parent))
        return NULL;
    ty_bytes bytes;
    ty_error error;
    ty_status status = ty_file_read(path, TY_TREE_MAX_FILE, &bytes, &error);
    if (status != TY_OK)
    {
        if (named_at)
            ty_report_error(job->tree->errors, *named_at, path, &error);
        else
            ty_error_list_add(job->tree->errors, &error);
        job->tree->stopped = true;
        return NULL;
    }
    ty_include self = {parent, real, parent ? parent->depth + 1 : 1};
    ty_node* root = ty_tree_parse(job->tree, make_source(job->tree, path, base), bytes.data, bytes.size);
    ty_bytes_term(&bytes);
    return finish(job, root, &self);
}

ty_node* ty_document_load(ty_tree* tree, ty_files* files, const char* path, const char* base, const ty_place* named_at)
{
    ty_including job = {tree, files};
    return load(&job, path, base, named_at, NULL);
}

ty_node* ty_document_parse(ty_tree* tree, ty_files* files, const char* name, const void* bytes, size_t size)
{
    ty_including job = {tree, files};
    ty_include self = {NULL, name, 1};
    return finish(&job, ty_tree_parse(tree, make_source(tree, name, ""), bytes, size), &self);
}

void ty_document_take_version(ty_tree* tree, ty_node* root)
{
    char described[80];
    const ty_node* version = ty_node_get(root, "tsuya");
    if (!version)
        ty_report(tree->errors, root->place, TY_BAD_INPUT, "missing key 'tsuya': a file begins with 'tsuya: 1'");
    else if (version->kind != TY_NODE_SCALAR || strcmp(version->text, "1") != 0)
        ty_report(tree->errors, version->place, TY_BAD_INPUT, "'tsuya': this program reads version 1, got %s",
                  ty_node_describe(version, described));
    ty_node_remove(tree, root, "tsuya");
}
