// SPDX-License-Identifier: Apache-2.0
// Voxels of a looping texture: numbers 0..1 in sixteen bits, and colours that they carry.
#pragma once
#include <tsuya/base/math.h>
#include <tsuya/generate/loop_recipe.h>

#define TY_LOOP_ONE 65535.0f // what 1 is among the numbers of a volume

// Colours as they stand in 8-bit images (sRGB), so that what comes back is what was there.
typedef struct ty_loop_palette
{
    uint8_t colors[TY_LOOP_COLORS][3];
    int count; // 0 = the volume has no colours of its own
    uint8_t background[3];
    bool clear; // the background is what is transparent, and that alone
} ty_loop_palette;

// Voxel (x, y, z) is at z * slice + y * row + x. Rows, columns and slices have one more at their end: a copy of the
// first where the volume wraps, else of the last, so that a voxel's next one always exists.
typedef struct ty_loop_volume
{
    int size[3]; // voxels along x, y (downwards), z
    size_t row, slice, count;
    bool wrap[3];
    uint16_t* values;
    uint8_t* labels; // index into the palette; NULL = none
    uint8_t* tints;  // or three numbers a voxel: mixed colours; NULL = none
    ty_loop_palette palette;
} ty_loop_volume;

// Zeroes. colored: with room for labels or, blended, for tints.
TY_CHECKED ty_status ty_loop_volume_create(const int size[3], bool colored, bool blended, ty_loop_volume* out,
                                           ty_error* error);
// Whether there may be such a volume.
TY_CHECKED ty_status ty_loop_size_check(const int size[3], ty_error* error);
void ty_loop_volume_term(ty_loop_volume* volume); // a zeroed one is allowed
// Writes the copies at the ends; after it nothing is written any more.
void ty_loop_volume_close(ty_loop_volume* volume);
// `count` voxels one after another, with their colours.
void ty_loop_volume_copy(ty_loop_volume* volume, size_t to, size_t from, size_t count);

static inline size_t ty_loop_voxel(const ty_loop_volume* volume, int x, int y, int z)
{
    return (size_t)z * volume->slice + (size_t)y * volume->row + (size_t)x;
}
static inline uint16_t ty_loop_number_of(float share) // clamped to 0..1; what is no number is 0
{
    return share > 0.0f ? (uint16_t)(ty_min(share, 1.0f) * TY_LOOP_ONE + 0.5f) : 0;
}

// --- sampling ---

// Pixel (i, j) looks at origin + i across + j down, in voxels from the middle of the first one.
typedef struct ty_loop_grid
{
    ty_vec3 origin, across, down;
} ty_loop_grid;

// Values 0..1 of pixels [from, to) of row j, 0 where the volume is not. The same bits on every machine.
typedef void ty_loop_sample_fn(const ty_loop_volume* volume, const ty_loop_grid* grid, int sampling, int j, int from,
                               int to, float* out);
ty_loop_sample_fn ty_loop_sample_base, ty_loop_sample_avx512;
ty_loop_sample_fn* ty_loop_sampler(void); // the fastest of this machine

typedef struct ty_loop_corners
{
    size_t at[8];    // voxels
    float weight[8]; // of their values; adds up to 1 but where the volume is not: 0
} ty_loop_corners;

// The voxels that a place lies between.
ty_loop_corners ty_loop_corners_of(const ty_loop_volume* volume, const ty_loop_grid* grid, int sampling, int i, int j);
// The colour's index of which there is most among them, by value.
int ty_loop_label_of(const ty_loop_volume* volume, const ty_loop_corners* corners);
// The mean of their tints by value; out stays where nothing has a value.
void ty_loop_tint_of(const ty_loop_volume* volume, const ty_loop_corners* corners, uint8_t out[3]);

// --- making ---

// The size of what volume_make will give and where it wraps, without voxels: all mistakes of the parts that can be
// told before any work.
TY_CHECKED ty_status ty_loop_volume_check(const ty_loop_recipe* recipe, ty_loop_volume* shape, ty_error* error);
// All parts of a recipe: the first gives the size, others are laid with their middles on its middle.
TY_CHECKED ty_status ty_loop_volume_make(const ty_loop_recipe* recipe, ty_workers* workers, ty_loop_volume* out,
                                         ty_error* error);

// What the sources give, before any building. Closed by the caller. check: its size alone.
TY_CHECKED ty_status ty_loop_source_check(const ty_loop_part* part, int index, int size[3], ty_error* error);
TY_CHECKED ty_status ty_loop_source_make(const ty_loop_part* part, int index, ty_workers* workers, ty_loop_volume* out,
                                         ty_error* error);
TY_CHECKED ty_status ty_loop_reaction_check(const ty_loop_part* part, int index, int size[3], ty_error* error);
TY_CHECKED ty_status ty_loop_reaction_make(const ty_loop_part* part, int index, ty_workers* workers,
                                           ty_loop_volume* out, ty_error* error);
// What becomes 0, and one over the length of what becomes 0..1, by the part's range; without one it ends at `high`.
TY_CHECKED ty_status ty_loop_range(const ty_loop_part* part, int index, float high, float* low, float* scale,
                                   ty_error* error);
// A mistake that begins with a key of one of its groups, told as the part's.
ty_status ty_loop_part_error(ty_status status, int index, const char* group, ty_error* error);
static inline bool ty_loop_part_is_colored(const ty_loop_part* part)
{
    return part->colors > 0 && (part->source == TY_LOOP_STACK || part->source == TY_LOOP_STILL ||
                                (part->source == TY_LOOP_REACTION && part->reaction.logo));
}

// One step of `colors` planes [height][width] that v is the sum of, which wrap as the field does; before the field's
// own step. False when cancelled.
bool ty_loop_colors_step(ty_gray_scott* field, const ty_loop_reaction* def, const int size[2], int colors,
                         const float* from, float* to, ty_workers* workers);

// An image as labels: 0..count - 1, or TY_LOOP_BACKGROUND.
#define TY_LOOP_BACKGROUND 255
typedef struct ty_loop_labels
{
    int width, height;
    uint8_t* labels; // [height][width], owned
    ty_loop_palette palette;
} ty_loop_labels;

// At most `colors` are told apart (0: none, all that is not background is label 0 and the palette has no colours). The
// image's own where it has no more, else by median cut (Heckbert 1982) and means. given NULL: the image's own
// palette, else this one. cells: the size to bring it to by nearest pixels; 0 = as it is.
TY_CHECKED ty_status ty_loop_labels_read(const char* path, const char* key, int colors, const int cells[2],
                                         const ty_loop_palette* given, ty_loop_labels* out, ty_error* error);
void ty_loop_labels_term(ty_loop_labels* labels);
// Slice z of a volume of that size and palette: wholly inside or wholly outside.
void ty_loop_labels_put(const ty_loop_labels* labels, int z, ty_loop_volume* volume);
