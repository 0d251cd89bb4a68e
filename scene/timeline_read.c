// SPDX-License-Identifier: Apache-2.0
// Keyed values of a scene file: found, checked, and made into tracks.
#include "nearest.h"
#include "number.h"
#include "timeline.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char* const interpolations[] = {"linear", "smooth", "ease", "hold", NULL};
static const char* const outsides[] = {"hold", "loop", "mirror", "continue", "error", NULL};
static const char* const option_keys[] = {"keys", "interpolate", "before", "after", NULL};
static const ty_param key_row = {.name = "keys", .type = TY_PARAM_FLOAT, .unit = "", .minimum = -1e12, .maximum = 1e12};
static const ty_param color_row = {.name = "keys", .type = TY_PARAM_RGB, .unit = ""};

#define MOST_FRAME 1e7 // exact to far less than a thousandth of a frame

typedef struct collector
{
    ty_timeline* timeline;
    ty_tree* tree;
    ty_reader* reader;
    ty_section_kind section;
    int index;
    const char* key; // of the mapping that the value stands in
} collector;

typedef struct timed
{
    double time;
    ty_node* value;
} timed;

static int by_time(const void* a, const void* b)
{
    double first = ((const timed*)a)->time, second = ((const timed*)b)->time;
    return first < second ? -1 : first > second;
}

static void* grow(collector* c, void* items, int count, int* capacity, size_t size)
{
    if (count < *capacity)
        return items;
    int larger = *capacity ? 2 * *capacity : 16;
    void* grown = ty_arena_alloc(c->tree->arena, (size_t)larger, size);
    if (count)
        memcpy(grown, items, (size_t)count * size);
    *capacity = larger;
    return grown;
}

// Sorted by time; NULL after a report.
static timed* read_times(collector* c, const ty_node* keys)
{
    char described[80];
    if (keys->kind != TY_NODE_MAP || keys->count == 0)
    {
        ty_report(c->reader->errors, keys->place, TY_BAD_INPUT,
                  "'keys': expected a mapping of frames to values, { 1: 0.2, 48: 0.6 }, got %s",
                  keys->count ? ty_node_describe(keys, described) : "nothing");
        return NULL;
    }
    timed* list = TY_ARENA_ALLOC(c->tree->arena, timed, keys->count);
    bool good = true;
    for (int i = 0; i < keys->count; ++i)
    {
        list[i].value = keys->items[i];
        if (ty_number_parse(keys->keys[i].text, &list[i].time) && fabs(list[i].time) <= MOST_FRAME)
            continue;
        ty_report(c->reader->errors, keys->keys[i].place, TY_BAD_INPUT,
                  "'keys': expected a frame number -1e7..1e7, got '%.60s'", keys->keys[i].text);
        good = false;
    }
    qsort(list, (size_t)keys->count, sizeof *list, by_time);
    for (int i = 1; i < keys->count && good; ++i)
        if (!(list[i].time > list[i - 1].time))
        {
            ty_report(c->reader->errors, list[i].value->place, TY_BAD_INPUT, "'keys': frame %.9g stands there twice",
                      list[i].time);
            good = false;
        }
    return good ? list : NULL;
}

static bool is_word(const ty_node* node)
{
    return node->kind == TY_NODE_SCALAR && (strcmp(node->text, "true") == 0 || strcmp(node->text, "false") == 0);
}

// '#rrggbb' and { color, space }: taken to ACEScg, in which they are interpolated.
static bool is_spelled_color(const ty_node* node)
{
    return (node->kind == TY_NODE_SCALAR && node->text[0] == '#') || node->kind == TY_NODE_MAP;
}

static bool read_number(collector* c, const ty_node* node, double* out)
{
    float checked;
    return ty_param_read_number(c->reader, node, &key_row, &checked) && ty_number_parse(node->text, out);
}

static bool read_color(collector* c, ty_node* node, double* out)
{
    ty_rgb color;
    if (!ty_param_read_rgb(c->reader, node, &color_row, &color))
        return false;
    out[0] = (double)color.r;
    out[1] = (double)color.g;
    out[2] = (double)color.b;
    return true;
}

static bool read_value(collector* c, const ty_track* track, bool colors, ty_node* node, double* out)
{
    char described[80];
    if (colors)
        return read_color(c, node, out);
    if (track->is_word && is_word(node))
    {
        *out = strcmp(node->text, "true") == 0 ? 1.0 : 0.0;
        return true;
    }
    bool fits = !track->is_word && (node->kind == TY_NODE_LIST) == track->is_list &&
                (!track->is_list || node->count == track->components);
    if (!fits)
    {
        ty_report(c->reader->errors, node->place, TY_BAD_INPUT, "'keys': expected %s as in the first key, got %s",
                  track->is_word   ? "true or false"
                  : track->is_list ? "a list of as many numbers"
                                   : "a number",
                  ty_node_describe(node, described));
        return false;
    }
    bool good = true;
    for (int i = 0; i < track->components; ++i)
        good &= read_number(c, track->is_list ? node->items[i] : node, &out[i]);
    return good;
}

static bool read_values(collector* c, ty_track* track, const timed* list)
{
    ty_arena* arena = c->tree->arena;
    const ty_node* first = list[0].value;
    bool colors = false;
    for (int i = 0; i < track->key_count; ++i)
        colors |= is_spelled_color(list[i].value);
    if (colors && strcmp(c->key, "color") == 0) // of a colour with a space: numbers alone
        colors = false;
    track->is_word = is_word(first);
    track->is_list = colors || first->kind == TY_NODE_LIST;
    track->components = colors ? 3 : track->is_list ? first->count : 1;
    track->times = TY_ARENA_ALLOC(arena, double, track->key_count);
    track->keyed_at = TY_ARENA_ALLOC(arena, ty_place, track->key_count);
    track->values = TY_ARENA_ALLOC(arena, double, track->key_count * track->components);
    bool good = true;
    for (int i = 0; i < track->key_count; ++i)
    {
        track->times[i] = list[i].time;
        track->keyed_at[i] = list[i].value->place;
        good &= read_value(c, track, colors, list[i].value, track->values + (ptrdiff_t)i * track->components);
    }
    return good;
}

static bool read_choice(collector* c, const ty_node* map, const char* name, const char* const* choices, int* out)
{
    ty_node* node = ty_node_get(map, name);
    const ty_param row = {.name = name, .type = TY_PARAM_ENUM, .unit = "", .choices = choices};
    return !node || ty_param_read(c->reader, node, &row, out);
}

static bool read_options(collector* c, const ty_node* map, ty_track* track)
{
    int interpolate = track->is_word ? TY_INTERPOLATE_HOLD : TY_INTERPOLATE_LINEAR, after = TY_OUTSIDE_HOLD;
    bool good = read_choice(c, map, "interpolate", interpolations, &interpolate);
    good &= read_choice(c, map, "after", outsides, &after);
    int before = after;
    good &= read_choice(c, map, "before", outsides, &before);
    track->interpolation = (ty_interpolation)interpolate;
    track->after = (ty_outside)after;
    track->before = (ty_outside)before;
    if (good && track->is_word && track->interpolation != TY_INTERPOLATE_HOLD)
    {
        ty_report(c->reader->errors, ty_node_get(map, "interpolate")->place, TY_BAD_INPUT,
                  "'interpolate': true and false can only hold");
        return false;
    }
    bool needs_two = after >= TY_OUTSIDE_LOOP && after <= TY_OUTSIDE_CONTINUE;
    needs_two |= before >= TY_OUTSIDE_LOOP && before <= TY_OUTSIDE_CONTINUE;
    if (good && needs_two && track->key_count < 2)
    {
        ty_report(c->reader->errors, map->place, TY_BAD_INPUT, "loop, mirror and continue need two keys at least");
        return false;
    }
    return good;
}

// Steffen 1990, "A simple method for monotonic interpolation in one dimension": slopes that never overshoot.
static double steffen(double h0, double rise0, double h1, double rise1)
{
    double s0 = rise0 / h0, s1 = rise1 / h1, p = (s0 * h1 + s1 * h0) / (h0 + h1);
    if (s0 * s1 <= 0.0)
        return 0.0;
    double least = fabs(s0) < fabs(s1) ? fabs(s0) : fabs(s1), size = fabs(p) < 2.0 * least ? fabs(p) : 2.0 * least;
    return s0 < 0.0 ? -size : size;
}

static void set_slopes(collector* c, ty_track* track)
{
    int n = track->components, count = track->key_count;
    track->slopes = TY_ARENA_ALLOC(c->tree->arena, double, count* n);
    if (track->interpolation != TY_INTERPOLATE_SMOOTH || count < 2)
        return;
    bool loops = track->after == TY_OUTSIDE_LOOP;
    const double* t = track->times;
    for (int component = 0; component < n; ++component)
    {
        const double* v = track->values + component;
        double* m = track->slopes + component;
        for (int i = 0; i < count; ++i)
        {
            int a = i > 0 ? i - 1 : loops ? count - 2 : -1, b = i + 1 < count ? i : loops ? 0 : -1; // segments
            double first = (v[n] - v[0]) / (t[1] - t[0]);
            double last = (v[(count - 1) * n] - v[(count - 2) * n]) / (t[count - 1] - t[count - 2]);
            m[i * n] = a < 0   ? first
                       : b < 0 ? last
                               : steffen(t[a + 1] - t[a], v[(a + 1) * n] - v[a * n], t[b + 1] - t[b],
                                         v[(b + 1) * n] - v[b * n]);
        }
    }
}

static ty_node* make_scalar(collector* c, ty_place place)
{
    ty_node* node = ty_node_create(c->tree, TY_NODE_SCALAR, place);
    if (node)
        node->text = TY_ARENA_ALLOC(c->tree->arena, char, TY_TRACK_TEXT);
    return node;
}

static ty_node* make_value(collector* c, const ty_track* track)
{
    if (!track->is_list)
        return make_scalar(c, track->keyed_at[0]);
    ty_node* list = ty_node_create(c->tree, TY_NODE_LIST, track->keyed_at[0]);
    for (int i = 0; list && i < track->components; ++i)
    {
        ty_node* item = make_scalar(c, track->keyed_at[0]);
        if (!item)
            return NULL;
        ty_node_append(c->tree, list, item);
    }
    return list;
}

static void add_track(collector* c, const ty_track* track)
{
    ty_timeline* t = c->timeline;
    ty_animated* last = t->entry_count ? &t->entries[t->entry_count - 1] : NULL;
    if (!last || last->section != c->section || last->index != c->index)
    {
        t->entries = grow(c, t->entries, t->entry_count, &t->entry_capacity, sizeof *t->entries);
        last = &t->entries[t->entry_count++];
        *last = (ty_animated){.section = c->section, .index = c->index, .first_track = t->track_count};
    }
    t->tracks = grow(c, t->tracks, t->track_count, &t->track_capacity, sizeof *t->tracks);
    t->tracks[t->track_count++] = *track;
    last->track_count++;
}

static void read_keyed(collector* c, ty_node** slot)
{
    ty_node* map = *slot;
    ty_track track = {.keyed = map, .slot = slot};
    bool good = ty_params_check_keys(c->reader, map, option_keys, "a keyed value");
    const ty_node* keys = ty_node_get(map, "keys");
    track.key_count = keys->count;
    const timed* list = read_times(c, keys);
    good = list && read_values(c, &track, list) && good;
    good = good && read_options(c, map, &track);
    if (!good || c->tree->stopped)
    {
        map->bad = true; // the readers say no more about it
        return;
    }
    set_slopes(c, &track);
    track.value = make_value(c, &track);
    if (!track.value)
        return;
    add_track(c, &track);
    *slot = track.value;
}

static void collect(collector* c, ty_node** slot, int depth)
{
    ty_node* node = *slot;
    if (depth > TY_TREE_MAX_DEPTH || c->tree->stopped)
        return;
    if (ty_node_find(node, "keys") >= 0)
    {
        read_keyed(c, slot);
        return;
    }
    for (int i = 0; i < node->count; ++i)
    {
        if (node->kind == TY_NODE_MAP)
            c->key = node->keys[i].text;
        collect(c, &node->items[i], depth + 1);
    }
}

// Where nothing can change with time, keys are a mistake that is told as such.
static void refuse(collector* c, const ty_node* node, const char* why)
{
    for (int i = 0; i < node->count; ++i)
    {
        ty_node* item = node->items[i];
        if (ty_node_find(item, "keys") >= 0)
        {
            ty_report(c->reader->errors, item->place, TY_BAD_INPUT, "%s", why);
            item->bad = true;
        }
        else
            refuse(c, item, why);
    }
}

static void collect_entries(collector* c, ty_node* section)
{
    for (int i = 0; i < section->count; ++i)
    {
        c->index = i;
        for (int j = 0; j < section->items[i]->count; ++j)
        {
            if (section->items[i]->kind == TY_NODE_MAP)
                c->key = section->items[i]->keys[j].text;
            collect(c, &section->items[i]->items[j], 3);
        }
    }
}

void ty_timeline_collect(ty_timeline* timeline, ty_tree* tree, ty_reader* reader, ty_node* root)
{
    static const struct
    {
        const char* name;
        ty_section_kind section;
        bool is_entry; // the section itself, not each item of it
        const char* refusal;
    } sections[] = {
        {"camera", TY_SECTION_CAMERA, true, NULL},
        {"turntable", TY_SECTION_TURNTABLE, true, NULL},
        {"materials", TY_SECTION_MATERIAL, false, NULL},
        {"lights", TY_SECTION_LIGHT, false, NULL},
        {"objects", TY_SECTION_OBJECT, false, NULL},
        {"assets", 0, false, "assets are made once, for all frames: their values cannot be keyed"},
        {"film", 0, false, "film and render are the same for all frames: their values cannot be keyed"},
        {"render", 0, false, "film and render are the same for all frames: their values cannot be keyed"},
        {"timeline", 0, false, "a timeline's own values cannot be keyed"},
    };
    for (int s = 0; s < TY_PARAM_COUNT(sections); ++s)
    {
        collector c = {.timeline = timeline, .tree = tree, .reader = reader, .section = sections[s].section, .key = ""};
        ty_node* node = ty_node_get(root, sections[s].name);
        if (!node)
            continue;
        if (sections[s].refusal)
            refuse(&c, node, sections[s].refusal);
        else if (sections[s].is_entry)
            for (int i = 0; i < node->count; ++i)
            {
                if (node->kind == TY_NODE_MAP)
                    c.key = node->keys[i].text;
                collect(&c, &node->items[i], 2);
            }
        else
            collect_entries(&c, node);
    }
}
