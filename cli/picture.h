// SPDX-License-Identifier: Apache-2.0
// A picture file of any kind as named planes, with its layers.
#pragma once
#include "cli.h"
#include <tsuya/image/image.h>

typedef struct ty_picture
{
    const char* path; // borrowed
    ty_exr* exr;      // planes and windows; of files other than scanline EXR: R, G, B, A or Y, both windows alike
    bool is_display;  // integers, display values 0..1; else scene-linear
    char color_space[64];
} ty_picture;

TY_CHECKED ty_status ty_picture_read(const char* path, ty_picture* out, ty_error* error);
// A picture that was just rendered, with the values that its file would have; takes exr over.
void ty_picture_from_render(ty_exr* exr, const char* path, ty_picture* out);
void ty_picture_term(ty_picture* picture);

enum
{
    TY_LAYER_CHANNELS = 4,
    TY_LAYERS_MAX = 64,
};

// Channels that belong together: "beauty" (R, G, B or Y), "N" (N.X, N.Y, N.Z), "Z", "A".
typedef struct ty_layer
{
    char name[64];
    char channels[TY_LAYER_CHANNELS][64];
    int channel_count;
} ty_layer;

// The layers of a picture in a fixed order, beauty first; at most TY_LAYERS_MAX.
int ty_picture_layers(const ty_picture* picture, ty_layer out[TY_LAYERS_MAX]);
bool ty_layer_is_color(const ty_layer* layer); // red, green, blue

// The pixels x0, y0, x1, y1 (inclusive, within the data window) of a layer, interleaved; whole numbers as floats. The
// caller frees out.
TY_CHECKED ty_status ty_picture_take(const ty_picture* picture, const ty_layer* layer, const int window[4],
                                     ty_image* out, ty_error* error);
