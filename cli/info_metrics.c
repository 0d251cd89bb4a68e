// SPDX-License-Identifier: Apache-2.0
// The metrics of an aggregate in words with their units, as `tsuya info` prints them.
#include "cli.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct metric
{
    const char *key, *words, *unit;
} metric;

// In the order in which they are told.
static const metric metrics[] = {
    {"count", "elements", ""},
    {"rest", "at rest", ""},
    {"phi", "packing fraction, of the elements", ""},
    {"phi_balls", "packing fraction, of their balls", ""},
    {"contacts", "contacts of an element, gaps up to a micrometre, mean", ""},
    {"loaded", "contacts of an element that press on it, mean", ""},
    {"neighbours", "neighbours of an element up to 2 % of the width off, mean", ""},
    {"floating", "elements that are not held", ""},
    {"overlap_max_percent", "overlap, greatest", "% of the width"},
    {"overlap_mean_percent", "overlap, mean of the contacts", "% of the width"},
    {"settled_overlap_max_percent", "overlap before it was polished, greatest", "% of the width"},
    {"settled_overlap_mean_percent", "overlap before it was polished, mean of the contacts", "% of the width"},
    {"speed_rms_mm_s", "speed, root mean square", "mm/s"},
    {"speed_max_mm_s", "speed, greatest", "mm/s"},
    {"watched_s", "watched on at rest for", "s"},
    {"drift_mean_percent", "drift meanwhile, mean", "% of the width"},
    {"drift_max_percent", "drift meanwhile, greatest", "% of the width"},
    {"substeps", "substeps of settling", ""},
    {"lost", "elements that fell out", ""},
    {"replaced", "elements placed anew", ""},
    {"released_height_mm", "height of the topmost element as the mould was taken off", "mm"},
    {"height_mm", "height of the topmost element now", "mm"},
    {"wet_basis", "moisture, of the wet mass", ""},
    {"cooked", "degree of cooking", ""},
    {"swelling", "size of rice against its size when cooked", ""},
    {"modulus_kPa", "Young's modulus, when pressed", "kPa"},
    {"cohesion_N_m", "tension of the liquid between elements", "N/m"},
    {"adhesion_J_m2", "work of adhesion of starch", "J/m^2"},
    {"level_mm", "height of the filling", "mm"},
    {"crown_mm", "height of the crown above it", "mm"},
    {"start", "start of the filling", ""},
    {"removed", "elements taken out of the start", ""},
    {"start_overlap_max_percent", "overlap at the start, greatest", "% of the width"},
    {"start_overlap_mean_percent", "overlap at the start, mean of the contacts", "% of the width"},
    {"start_repeat_percent", "elements at the most frequent displacement, at the start", "%"},
    {"repeat_percent", "elements at the most frequent displacement", "%"},
};

#define METRIC_COUNT (sizeof(metrics) / sizeof(metrics[0]))

static void print_value(const char* words, const char* unit, const json_t* value, int indent)
{
    char* text = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(7));
    printf("%*s%s: %s%s%s\n", indent, "", words, text, *unit ? " " : "", unit);
    free(text); // jansson's own allocation
}

static bool is_known(const char* key)
{
    for (size_t i = 0; i < METRIC_COUNT; i++)
    {
        if (strcmp(metrics[i].key, key) == 0)
        {
            return true;
        }
    }
    return false;
}

void ty_info_print_metrics(const json_t* values, int indent)
{
    for (size_t i = 0; i < METRIC_COUNT; i++)
    {
        const json_t* value = json_object_get(values, metrics[i].key);
        if (value)
        {
            print_value(metrics[i].words, metrics[i].unit, value, indent);
        }
    }
    const char* key;
    json_t* value;
    json_object_foreach((json_t*)values, key, value)
    {
        if (!is_known(key)) // of another version: by its name
        {
            print_value(key, "", value, indent);
        }
    }
}
