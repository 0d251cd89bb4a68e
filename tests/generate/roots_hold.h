// SPDX-License-Identifier: Apache-2.0
// What roots promise, held against the files of one host: a manifold shell that holds on and goes no deeper.
#pragma once
#include "roots_file.h"
#include "roots_hosts.h"
#include <tsuya/generate/roots_recipe.h>

// Writes NAME_mesh.ply and NAME_curves.ply, forgets everything, and measures the files.
static roots_figures grow(const char* name, const ty_roots_recipe* recipe, const roots_ground* ground)
{
    ty_made made = {.wants_curves = true};
    ty_error error = {0};
    char mesh[64], curves[64];
    roots_figures figures;
    snprintf(mesh, sizeof mesh, "roots_%s_mesh.ply", name);
    snprintf(curves, sizeof curves, "roots_%s_curves.ply", name);
    ty_status status = ty_roots_make_all(recipe, NULL, &made, &error);
    if (status != TY_OK)
        print_message("%s: %s\n", name, error.text);
    assert_int_equal(status, TY_OK);
    assert_int_equal(ty_ply_write(mesh, made.mesh, &error), TY_OK);
    assert_int_equal(ty_file_write(curves, made.curves, strlen(made.curves), &error), TY_OK);
    ty_mesh_destroy(made.mesh);
    ty_free(made.curves);
    assert_true(roots_measure(mesh, curves, ground, &figures));
    print_message("%-9s %u triangles, %u shell, corners %.1f (0.1 %%: %.1f), deepest %.3f r (%+.4f), gap %.3f r of %u, "
                  "bends %.0f (1 %%: %.0f), joins %.0f (1 %%: %.0f), %d lines, %d parts, %d unseen\n",
                  name, figures.triangles, figures.components, figures.corner_least, figures.corner_1, figures.deepest,
                  figures.deeper, figures.gap_99, figures.attached, figures.bend_least, figures.bend_1,
                  figures.join_least, figures.join_1, figures.lines, figures.parts, figures.unseen);
    return figures;
}

// What roots promise: corners of 5 degrees at least (99.9 % of 15), gaps below 0.1 radii for 99 %, and bends of 100
// degrees, 99 % above 120.
#define CORNER_LEAST 5.0
#define GAP 0.1
#define BEND_LEAST 100.0
#define BEND_1 120.0

static void holds(const char* name, int detail)
{
    host_files files;
    host_make(name, detail, &files);
    ty_roots_recipe recipe = ty_roots_recipe_default();
    recipe.host.kind = TY_ROOTS_HOST_MESH;
    recipe.host.mesh = files.whole;
    recipe.detail = detail > 1 ? 0.5e-3f : 1e-3f;
    recipe.tip = 1e-3f;
    const roots_ground ground = {files.paths, files.count, recipe.host.floor};
    roots_figures f = grow(name, &recipe, &ground);
    assert_int_equal(f.boundary_edges, 0);
    assert_int_equal(f.nonmanifold_edges, 0);
    assert_true(f.closed);
    assert_int_equal(f.components, 1);
    assert_true(f.corner_least >= CORNER_LEAST && f.corner_1 >= 15.0);
    assert_true(f.deepest > 0.05); // it does reach under it
    assert_true(f.deeper <= 0.05);
    assert_true(f.attached > 100 && f.gap_99 <= GAP);
    assert_true(f.bend_least >= BEND_LEAST && f.bend_1 >= BEND_1);
    assert_true(f.join_least >= BEND_LEAST && f.join_1 >= BEND_1);
    assert_true(f.lines > 11);
    assert_int_equal(f.parts, 1);
    assert_int_equal(f.unseen, 0);
}
