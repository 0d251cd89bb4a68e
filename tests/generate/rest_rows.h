// SPDX-License-Identifier: Apache-2.0
// Piles that must come to rest, and what at rest means: bounds of speeds, drift, overlaps, contacts and packing.
#pragma once
#include "mesh_overlap.h"
#include "recipe_made.h"

typedef struct rest_bounds
{
    double phi[2];      // of the balls: they are what packs
    double contacts[2]; // that press
} rest_bounds;

static void rest_between(const char* what, double value, const double bounds[2])
{
    if (!(value >= bounds[0] && value <= bounds[1]))
        fail_msg("%s: %g is not in %g..%g", what, value, bounds[0], bounds[1]);
}

static void rest_below_of(const char* what, double value, double most)
{
    rest_between(what, value, (const double[2]){0.0, most});
}

static void rest_below(const ty_aggregate* a, const char* name, double most)
{
    rest_below_of(name, metric(a, name), most);
}

// Speeds in mm/s; overlaps and the drift over a further second in % of the width.
static void assert_at_rest(const char* name, const ty_aggregate* a, const rest_bounds* bounds)
{
    print_message(
        "%-12s %5.0f: v_rms %.4f mm/s, drift %.4f / %.3f %%, overlap %.3f / %.4f %%, polished %.4f / %.5f %%, "
        "phi %.3f (balls %.3f), contacts %.2f, %.0f substeps\n",
        name, metric(a, "count"), metric(a, "speed_rms_mm_s"), metric(a, "drift_mean_percent"),
        metric(a, "drift_max_percent"), metric(a, "settled_overlap_max_percent"),
        metric(a, "settled_overlap_mean_percent"), metric(a, "overlap_max_percent"), metric(a, "overlap_mean_percent"),
        metric(a, "phi"), metric(a, "phi_balls"), metric(a, "loaded"), metric(a, "substeps"));
    assert_non_null(strstr(a->metrics, "\"rest\": true"));
    rest_below(a, "speed_rms_mm_s", 0.3);
    rest_below(a, "drift_mean_percent", 0.05);
    rest_below(a, "drift_max_percent", 2.0);
    rest_below(a, "settled_overlap_max_percent", 2.0);
    rest_below(a, "settled_overlap_mean_percent", 0.2);
    rest_below(a, "overlap_max_percent", 0.1);
    rest_below(a, "overlap_mean_percent", 0.01);
    rest_below(a, "floating", 0.0);
    rest_between("phi_balls", metric(a, "phi_balls"), bounds->phi);
    rest_between("loaded", metric(a, "loaded"), bounds->contacts);
}

// Of the meshes as they are rendered, in % of the width; slot as of mesh_overlap_measure.
static void assert_meshes_apart(const ty_aggregate* a, const char* slot, float width, double most, double mean)
{
    mesh_overlap o = mesh_overlap_measure(a, slot, width);
    print_message("%-12s meshes overlap by %.3f %% at most, %.4f %% in the mean of %.2f pairs a body\n", "",
                  (double)o.most * 100.0, (double)o.mean * 100.0, (double)o.pairs);
    rest_below_of("meshes, most", (double)o.most * 100.0, most);
    rest_below_of("meshes, mean", (double)o.mean * 100.0, mean);
}

// --- bowls of which a smaller one is the same in other numbers ---

static void bowl_scale(ty_aggregate_recipe* r, float scale)
{
    r->container.shape.radius *= scale;
    r->container.shape.height *= scale;
    r->container.shape.foot_radius *= scale;
    r->fill.heap *= scale;
}

static ty_aggregate_recipe rice_bowl(int count)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    set_bowl(&r.container.shape, 0.0385f, 0.0385f, 0.0022f, 0.0165f, 0.005f);
    r.container.shape.curve = 3.0f;
    r.fill.heap = 0.014f;
    r.fill.count = count;
    bowl_scale(&r, ty_pow((float)count / (count < 1000 ? 1300.0f : 2000.0f), 1.0f / 3.0f));
    r.settle.watch = 1.0f;
    return r;
}

static ty_aggregate_recipe roe_bowl(int count)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.element.kind = TY_ELEMENT_ROE;
    r.element.variation = 0.05f;
    set_bowl(&r.container.shape, 0.0205f, 0.0125f, 0.0016f, 0.008f, 0.0006f);
    r.container.shape.curve = 2.6f;
    r.fill.heap = 0.012f;
    r.fill.count = count;
    r.fill.density = 0.62f;
    r.fill.sprinkle = 0.4f;
    bowl_scale(&r, ty_pow((float)count / 60.0f, 1.0f / 3.0f));
    r.settle.friction = 1.0f;
    r.settle.rolling = 0.1f;
    r.settle.watch = 1.0f;
    return r;
}
