// SPDX-License-Identifier: Apache-2.0
// The elements of a recipe, in each layer one kind or several by ratio, each in its variants.
#pragma once
#include "roe.h"
#include <tsuya/generate/aggregate_recipe.h>

enum
{
    MIXTURE_KINDS = 16, // at most, of all layers
};

typedef struct mixture_kind
{
    ty_element_def def; // complete
    int first, count;   // of its variants among the grains
    int layer;          // 0: the recipe's own elements
    float share;        // of the bodies of its layer, all together 1
} mixture_kind;

typedef struct mixture
{
    mixture_kind* kinds;
    int kind_count;
    ty_element* grains; // all variants of all kinds
    int grain_count;
    int* kind_of;                   // [grain_count]
    int first, end;                 // kinds of the layer that is selected; what follows is of it
    float volume;                   // m^3, of the mean body
    float width, length, thickness; // m, of the mean body
    float widest, longest;          // m, of the largest kind
    float variation;                // the largest
} mixture;

// Checks and makes all elements. On failure *out is zeroed; the error names the element.
TY_CHECKED ty_status mixture_init(const ty_aggregate_recipe* recipe, mixture* out, ty_error* error);
void mixture_term(mixture* m);
void mixture_select(mixture* m, int layer); // from now on draws are of that layer; it is 0 at first

// Which grain a body is, and its own size: chance by shares. Equal draws whatever the kinds are when there is one.
void mixture_draw(const mixture* m, ty_rng* rng, ty_body* body);

// The settled bodies as instances: first one a body, then the further bodies of eggs, all whites and all yolks. Takes
// the meshes of the grains. frames: where bodies are that have been bent, but eggs; NULL = as they stand. *owners
// (freed by the caller): [instance_count] the body that each is of. NULL: no memory.
TY_CHECKED ty_aggregate* mixture_write(mixture* m, ty_seed seed, const ty_body* bodies, const ty_affine* frames,
                                       uint32_t count, uint32_t** owners);
bool mixture_is_roe(const mixture* m, uint32_t grain);
// The same instances at another moment: transforms, velocities and spins. frames and owners as above, the latter
// written again; yolks: [count], of eggs.
void mixture_move(const mixture* m, ty_seed seed, const ty_body* bodies, const ty_affine* frames, const ty_yolk* yolks,
                  uint32_t count, uint32_t* owners, ty_aggregate* out);
