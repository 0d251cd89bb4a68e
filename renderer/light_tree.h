// SPDX-License-Identifier: Apache-2.0
// A tree of lights by place, direction and power, for choosing one of many (Conty Estevez & Kulla 2018, "Importance
// sampling of many lights with adaptive tree splitting"; the bounds as in pbrt's fourth edition, 12.6.3). Between the
// bounds, which say where no light can come from, we estimate what comes rather than the most that might.
#pragma once
#include <tsuya/base/math.h>

// Lights within a box that send light at most cos_e beyond normals within cos_o of the axis.
typedef struct ty_light_node
{
    ty_vec3 low, high; // m
    ty_vec3 axis;      // unit
    float cos_o;       // of the half angle of the normals' cone; -1 = all directions
    float cos_e;       // of how far beyond it there is light: 0 for surfaces
    float energy;      // radiant intensity at best, luminance
    float even;        // share of the energy that goes everywhere alike
    ty_vec3 mean;      // of the normals of the rest, by energy, times its share
    uint32_t child;    // the second child (the first is the next node); a leaf's item with TY_LIGHT_LEAF
} ty_light_node;

#define TY_LIGHT_LEAF 0x80000000u

typedef struct ty_light_tree
{
    ty_light_node* nodes; // [2 count - 1], depth first
    uint64_t* trails;     // [item_count]: the turns from the root to the item's leaf, the lowest bit first
    uint8_t* depths;      // [item_count], 255 = the item is not in the tree
    int count, item_count;
} ty_light_tree;

// leaves: count of them, each with its item below item_count in `child`; they are reordered. Deterministic. NULL when
// count is 0.
ty_light_tree* ty_light_tree_create(ty_light_node* leaves, int count, int item_count);
void ty_light_tree_destroy(ty_light_tree* tree); // NULL is allowed

// Irradiance that a node's lights are likely to give at p. normal zero: any side. 0 = none can.
float ty_light_node_importance(const ty_light_node* node, ty_vec3 p, ty_vec3 normal);

// The item with its probability, -1 = none of them matters at p. *u is uniform again afterwards.
int ty_light_tree_sample(const ty_light_tree* tree, ty_vec3 p, ty_vec3 normal, double* u, float* probability);
float ty_light_tree_probability(const ty_light_tree* tree, ty_vec3 p, ty_vec3 normal, int item);
