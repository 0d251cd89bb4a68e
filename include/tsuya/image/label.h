// SPDX-License-Identifier: Apache-2.0
// Short texts in pictures, drawn with an alphabet of strokes of our own: no font file, the same bits everywhere.
#pragma once
#include <tsuya/image/image.h>

// size: pixels of a capital letter's height. ASCII; any other character is a box.
float ty_label_width(const char* text, float size); // pixels

// Draws text from x on, with its baseline at y (pixels, y down), over what is there; what lies outside is left out.
// color: a value for each channel of the image.
void ty_label_draw(ty_image* image, float x, float y, const char* text, float size, const float* color);

// As much of text as is at most width wide, with ".." for what is missing; out has `capacity` bytes.
void ty_label_fit(const char* text, float size, float width, char* out, size_t capacity);
