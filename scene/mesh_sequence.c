// SPDX-License-Identifier: Apache-2.0
// Meshes that change with time: files read as they are needed, blended between two where they have one topology.
#include "mesh_sequence.h"
#include <string.h>
#include <tsuya/geometry/mesh_file.h>

// --- reading the asset ---

// Every file from the first to the last must be there; which are not is one message.
bool ty_sequence_find_files(ty_loader* loader, const char* pattern, const ty_sequence_def* def, const char* what,
                            ty_place place, int* first, int* count)
{
    ty_frame_numbers numbers;
    ty_error error;
    char missing[256];
    if (ty_frame_numbers_find(pattern, &numbers, &error) != TY_OK)
    {
        ty_report_error(loader->errors, place, what, &error);
        return false;
    }
    bool is_given = def->last_frame >= def->first_frame;
    int last = is_given ? def->last_frame : numbers.numbers[numbers.count - 1];
    *first = is_given ? def->first_frame : numbers.numbers[0];
    int lacking = ty_frame_numbers_missing(&numbers, *first, last, missing, sizeof missing);
    if (lacking > 0)
        ty_report(loader->errors, place, TY_BAD_FILE, "%s: '%s' lacks %d of its frames: %s", what, pattern, lacking,
                  missing);
    *count = last - *first + 1;
    ty_frame_numbers_term(&numbers);
    return lacking == 0;
}

void ty_mesh_sequence_read(ty_loader* loader, ty_asset* asset, const ty_mesh_asset_def* def, ty_node* pattern)
{
    struct ty_scene_resources* resources = loader->scene->resources;
    ty_sequence_check(loader, &def->sequence, asset->place);
    const char* path = ty_files_use_frames(&loader->files, pattern, "mesh");
    if (!path)
        return;
    ty_mesh_sequence* s = TY_ARENA_ALLOC(loader->arena, ty_mesh_sequence, 1);
    *s = (ty_mesh_sequence){
        .pattern = path, .timing = ty_sequence_timing(&def->sequence), .loaded = {-1, -1}, .shown = {-1, -1}};
    asset->path = path;
    if (!ty_sequence_find_files(loader, path, &def->sequence, "mesh", asset->place, &s->first, &s->count))
        return;
    ty_check_sequence_covers(loader, &s->timing, s->count, asset->place);
    asset->sequence = resources->sequences[resources->sequence_count++] = s;
}

void ty_mesh_sequence_expect(ty_loader* loader, ty_asset* asset, const ty_mesh_asset_def* def)
{
    struct ty_scene_resources* resources = loader->scene->resources;
    ty_sequence_check(loader, &def->sequence, asset->place);
    ty_mesh_sequence* s = TY_ARENA_ALLOC(loader->arena, ty_mesh_sequence, 1);
    *s = (ty_mesh_sequence){
        .timing = ty_sequence_timing(&def->sequence), .first = 1, .loaded = {-1, -1}, .shown = {-1, -1}};
    int most = s->count = ty_recipe_frames(&asset->recipe);
    if (def->sequence.last_frame >= def->sequence.first_frame)
    {
        s->first = def->sequence.first_frame;
        s->count = def->sequence.last_frame - s->first + 1;
    }
    if (s->first < 1 || s->first + s->count - 1 > most)
        ty_report(loader->errors, asset->place, TY_BAD_INPUT, "mesh: frames %d to %d; the recipe makes 1 to %d",
                  s->first, s->first + s->count - 1, most);
    ty_check_sequence_covers(loader, &s->timing, s->count < most ? s->count : most, asset->place);
    asset->sequence = resources->sequences[resources->sequence_count++] = s;
}

void ty_mesh_sequence_destroy(ty_mesh_sequence* sequence)
{
    ty_mesh_destroy(sequence->frames[0]);
    ty_mesh_destroy(sequence->frames[1]);
}

// --- files ---

static bool same_attributes(const ty_mesh* a, const ty_mesh* b)
{
    bool same = a->attribute_count == b->attribute_count;
    for (int i = 0; same && i < a->attribute_count; ++i)
        same = strcmp(a->attributes[i].name, b->attributes[i].name) == 0 &&
               a->attributes[i].components == b->attributes[i].components;
    return same;
}

// What materials were promised.
static bool same_data(const ty_mesh* a, const ty_mesh* b)
{
    return !a->uvs == !b->uvs && same_attributes(a, b);
}

static bool same_topology(const ty_mesh* a, const ty_mesh* b)
{
    return a->vertex_count == b->vertex_count && a->triangle_count == b->triangle_count && same_data(a, b) &&
           memcmp(a->triangles, b->triangles, a->triangle_count * sizeof(*a->triangles)) == 0;
}

// The file of index i (from 0) against the first that was read, if any. NULL after a report.
static ty_mesh* read_file(ty_loader* loader, const ty_mesh_sequence* s, int i, const ty_mesh* like, ty_place place)
{
    char path[TY_PATH_MAX];
    ty_error error;
    ty_mesh* mesh = NULL;
    ty_path_frame(s->pattern, s->first + i, path);
    if (ty_mesh_read_frame(path, &mesh, &error) != TY_OK)
    {
        ty_report_error(loader->errors, place, "mesh", &error);
        return NULL;
    }
    if (like && !s->timing.blend && !same_data(like, mesh))
    {
        ty_report(loader->errors, place, TY_BAD_FILE,
                  "mesh: frame %d, '%s': its attributes, or whether it has uv, are not those of the others",
                  s->first + i, path);
        ty_mesh_destroy(mesh);
        return NULL;
    }
    if (like && s->timing.blend && !same_topology(like, mesh))
    {
        ty_report(loader->errors, place, TY_BAD_FILE,
                  "mesh: frame %d, '%s': its %u vertices, %u triangles or attributes are not those of the others (%u, "
                  "%u): a sequence has one topology, but with 'interpolate: none'",
                  s->first + i, path, mesh->vertex_count, mesh->triangle_count, like->vertex_count,
                  like->triangle_count);
        ty_mesh_destroy(mesh);
        return NULL;
    }
    ty_convert_colors(loader, mesh);
    return mesh;
}

bool ty_mesh_sequence_files(ty_loader* loader, ty_mesh_sequence* s, const int wanted[2], const ty_mesh* like,
                            ty_place place)
{
    if (s->loaded[0] == wanted[1] || s->loaded[1] == wanted[0])
    {
        ty_mesh* mesh = s->frames[0];
        int loaded = s->loaded[0];
        s->frames[0] = s->frames[1];
        s->loaded[0] = s->loaded[1];
        s->frames[1] = mesh;
        s->loaded[1] = loaded;
    }
    for (int k = 0; k < 2; ++k)
    {
        if (s->loaded[k] == wanted[k] || (k == 1 && wanted[0] == wanted[1]))
            continue;
        ty_mesh* mesh = read_file(loader, s, wanted[k], like, place);
        if (!mesh)
            return false;
        ty_mesh_destroy(s->frames[k]);
        s->frames[k] = mesh;
        s->loaded[k] = wanted[k];
        like = like ? like : mesh;
    }
    return true;
}

// --- blending ---

void ty_mesh_blend_floats(float* out, const float* a, const float* b, size_t count, float weight)
{
    for (size_t i = 0; i < count; ++i)
        out[i] = a[i] + (b[i] - a[i]) * weight;
}

void ty_mesh_blend_normals(ty_vec3* out, const ty_mesh* a, const ty_mesh* b, float weight)
{
    ty_mesh_blend_floats(&out[0].x, &a->normals[0].x, &b->normals[0].x, 3 * (size_t)a->vertex_count, weight);
    for (size_t i = 0; i < a->vertex_count; ++i)
        out[i] = ty_length_sqr(out[i]) > 0.0f ? ty_normalize(out[i]) : a->normals[i];
}

// Of another topology. Who holds on to the list of attributes finds the new ones in it.
static void replace(ty_mesh* out, const ty_mesh* from)
{
    ty_mesh *copy = ty_mesh_copy(from), old = *out;
    *out = *copy;
    *copy = old;
    ty_mesh_attribute* list = out->attributes;
    for (int k = 0; k < out->attribute_count; ++k)
    {
        float* values = old.attributes[k].values;
        old.attributes[k].values = list[k].values;
        list[k].values = values;
    }
    out->attributes = old.attributes;
    copy->attributes = list;
    ty_mesh_destroy(copy);
}

static void blend(ty_mesh* out, const ty_mesh* a, const ty_mesh* b, float weight)
{
    size_t n = out->vertex_count;
    ty_mesh_blend_floats(&out->positions[0].x, &a->positions[0].x, &b->positions[0].x, 3 * n, weight);
    ty_mesh_blend_normals(out->normals, a, b, weight);
    if (out->uvs)
        ty_mesh_blend_floats(&out->uvs[0].x, &a->uvs[0].x, &b->uvs[0].x, 2 * n, weight);
    for (int k = 0; k < out->attribute_count; ++k)
        ty_mesh_blend_floats(out->attributes[k].values, a->attributes[k].values, b->attributes[k].values,
                             n * (size_t)out->attributes[k].components, weight);
    ty_free(out->curvature_1);
    ty_free(out->curvature_2);
    ty_free(out->direction_1);
    out->curvature_1 = out->curvature_2 = NULL;
    out->direction_1 = NULL;
    ty_mesh_compute_welds(out);
    ty_mesh_compute_bounds(out);
}

// The asset's mesh at the scene's seconds. False after a report.
static bool show(ty_loader* loader, ty_asset* asset)
{
    ty_mesh_sequence* s = asset->sequence;
    int wanted[2];
    float weight;
    if (!ty_sequence_at(&s->timing, s->count, loader->scene->seconds, wanted, &weight))
    {
        ty_report(loader->errors, asset->place, TY_BAD_INPUT, "mesh: %g s is outside of the sequence",
                  loader->scene->seconds);
        return false;
    }
    if (!(weight > 0.0f))
        wanted[1] = wanted[0];
    bool same_weight = !(weight < s->weight) && !(weight > s->weight);
    if (wanted[0] == s->shown[0] && wanted[1] == s->shown[1] && same_weight)
        return true;
    if (!ty_mesh_sequence_files(loader, s, wanted, asset->mesh, asset->place))
        return false;
    if (!asset->mesh)
        asset->mesh = ty_mesh_copy(s->frames[0]);
    else if (!s->timing.blend)
        replace(asset->mesh, s->frames[0]);
    blend(asset->mesh, s->frames[0], s->frames[wanted[0] == wanted[1] ? 0 : 1], weight);
    memcpy(s->shown, wanted, sizeof wanted);
    s->weight = weight;
    s->changed = true;
    return true;
}

// A check looks at every file.
static void check_files(ty_loader* loader, const ty_asset* asset)
{
    for (int i = 0; asset->mesh && i < asset->sequence->count; ++i)
        ty_mesh_destroy(read_file(loader, asset->sequence, i, asset->mesh, asset->place));
}

void ty_mesh_sequence_load(ty_loader* loader, ty_asset* asset)
{
    if (asset->frames) // of a recipe
        asset->sequence->pattern = asset->frames;
    (void)show(loader, asset); // what is wrong is in the list of errors
    asset->sequence->changed = false;
    if (loader->options->check_only)
        check_files(loader, asset);
}

void ty_set_mesh_times(ty_loader* loader)
{
    for (int i = 0; i < loader->asset_count; ++i)
    {
        ty_asset* asset = &loader->assets[i];
        if (!asset->sequence || !asset->mesh)
            continue;
        asset->sequence->changed = false;
        if (!show(loader, asset) || !asset->sequence->changed)
            continue;
        ty_complete_mesh(loader, asset->mesh);
        asset->bounds_known = false;
        loader->world_changed = true;
    }
}

bool ty_mesh_has_changed(const ty_loader* loader, const ty_mesh* mesh)
{
    for (int i = 0; i < loader->asset_count; ++i)
        if (loader->assets[i].sequence && loader->assets[i].mesh == mesh && loader->assets[i].sequence->changed)
            return true;
    return false;
}
