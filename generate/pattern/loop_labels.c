// SPDX-License-Identifier: Apache-2.0
// An image as a few colours: its own where they are few, else by median cut (Heckbert 1982) and means (Lloyd 1982).
#include "loop_volume.h"
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/color.h>
#include <tsuya/image/image.h>

enum
{
    ROUNDS = 8,               // of means
    MOST = TY_LOOP_COLORS + 1 // with the background
};

typedef struct entry
{
    uint8_t c[3];
    int64_t count; // pixels
} entry;

typedef struct box
{
    int begin, end; // entries
} box;

typedef struct quantizer
{
    entry* entries;
    int count;
    uint8_t means[MOST][3];
    int mean_count;
} quantizer;

void ty_loop_labels_term(ty_loop_labels* labels)
{
    ty_free(labels->labels);
    *labels = (ty_loop_labels){0};
}

static uint32_t code_of(const uint8_t* c)
{
    return (uint32_t)c[0] << 16 | (uint32_t)c[1] << 8 | c[2];
}

static int code_order(const void* a, const void* b)
{
    uint32_t p = *(const uint32_t*)a, q = *(const uint32_t*)b;
    return (p > q) - (p < q);
}

static int red_order(const void* a, const void* b)
{
    return ((const entry*)a)->c[0] - ((const entry*)b)->c[0];
}
static int green_order(const void* a, const void* b)
{
    return ((const entry*)a)->c[1] - ((const entry*)b)->c[1];
}
static int blue_order(const void* a, const void* b)
{
    return ((const entry*)a)->c[2] - ((const entry*)b)->c[2];
}

// --- pixels ---

// [height][width]: 0xRRGGBB, or TRANSPARENT where the image is. As much again follows, to sort in.
#define TRANSPARENT 0x1000000u

static ty_status codes_read(const char* path, const char* key, ty_image* image, uint32_t** out, ty_error* error)
{
    ty_status status = ty_image_read(path, image, error);
    if (status != TY_OK)
        return status;
    int n = image->width * image->height;
    size_t channels = (size_t)image->channels;
    *out = TY_TRY_ALLOC(uint32_t, (size_t)2 * (size_t)n);
    float* rgb = TY_TRY_ALLOC(float, (size_t)3 * (size_t)n);
    if (!*out || !rgb)
        status =
            ty_error_set(error, TY_NO_MEMORY, "%s: no memory for %d x %d pixels", key, image->width, image->height);
    for (size_t i = 0; i < (size_t)n && status == TY_OK; i++)
        for (size_t c = 0; c < 3; c++)
            rgb[3 * i + c] = image->pixels[i * channels + (channels < 3 ? 0 : c)];
    ty_color* color = NULL;
    if (status == TY_OK && image->is_float)
        status = ty_color_create(NULL, &color, error);
    if (status == TY_OK && image->is_float)
        status = ty_color_convert(color, ty_color_guess_space(color, true, image->color_space), "srgb_texture", rgb, n,
                                  3, error);
    ty_color_destroy(color);
    for (size_t i = 0; i < (size_t)n && status == TY_OK; i++)
    {
        bool clear = (channels == 2 || channels == 4) && image->pixels[(i + 1) * channels - 1] < 0.5f;
        uint8_t c[3];
        for (size_t k = 0; k < 3; k++)
            c[k] = (uint8_t)(ty_clamp(rgb[3 * i + k], 0.0f, 1.0f) * 255.0f + 0.5f);
        (*out)[i] = clear ? TRANSPARENT | code_of(c) : code_of(c);
    }
    ty_free(rgb);
    if (status != TY_OK)
    {
        ty_free(*out);
        ty_image_term(image);
    }
    return status;
}

// The most frequent of the codes.
static uint32_t mode_of(uint32_t* codes, int count)
{
    uint32_t best = 0;
    int best_run = 0, run = 0;
    qsort(codes, (size_t)count, sizeof *codes, code_order);
    for (int i = 0; i < count; i++)
    {
        run = i > 0 && codes[i] == codes[i - 1] ? run + 1 : 1;
        if (run > best_run)
        {
            best_run = run;
            best = codes[i];
        }
    }
    return best;
}

// What is transparent, else the colour of most of the rim.
static uint32_t background_of(uint32_t* codes, int w, int h)
{
    int n = 0;
    uint32_t* rim = codes + (size_t)w * (size_t)h;
    for (int i = 0; i < w * h; i++)
        if (codes[i] & TRANSPARENT)
            rim[n++] = codes[i];
    bool clear = n > 0;
    for (int i = 0; i < w * h && !clear; i++)
        if (i < w || i >= w * (h - 1) || i % w == 0 || i % w == w - 1)
            rim[n++] = codes[i];
    return mode_of(rim, n);
}

// --- colours ---

// Every colour that occurs, with its number of pixels; transparent ones are left out. False: no memory.
static bool entries_take(quantizer* q, uint32_t* codes, int n)
{
    uint32_t* sorted = codes + n;
    int count = 0;
    memcpy(sorted, codes, (size_t)n * sizeof *sorted);
    qsort(sorted, (size_t)n, sizeof *sorted, code_order);
    for (int i = 0; i < n && !(sorted[i] & TRANSPARENT); i++)
        count += i == 0 || sorted[i] != sorted[i - 1];
    q->entries = TY_TRY_ALLOC(entry, count);
    for (int i = 0; q->entries && i < n && !(sorted[i] & TRANSPARENT); i++)
    {
        if (i == 0 || sorted[i] != sorted[i - 1])
            q->entries[q->count++] =
                (entry){{(uint8_t)(sorted[i] >> 16), (uint8_t)(sorted[i] >> 8), (uint8_t)sorted[i]}, 0};
        q->entries[q->count - 1].count++;
    }
    return q->entries != NULL;
}

// The longest side of a box (0 red, 1 green, 2 blue) and its length.
static int box_side(const quantizer* q, box b, int* side)
{
    int longest = -1;
    for (int c = 0; c < 3; c++)
    {
        int low = 255, high = 0;
        for (int i = b.begin; i < b.end; i++)
        {
            low = q->entries[i].c[c] < low ? q->entries[i].c[c] : low;
            high = q->entries[i].c[c] > high ? q->entries[i].c[c] : high;
        }
        if (high - low > longest)
        {
            longest = high - low;
            *side = c;
        }
    }
    return longest;
}

static int64_t box_pixels(const quantizer* q, box b)
{
    int64_t sum = 0;
    for (int i = b.begin; i < b.end; i++)
        sum += q->entries[i].count;
    return sum;
}

static void box_mean(quantizer* q, box b)
{
    int64_t sum[3] = {0}, total = box_pixels(q, b);
    for (int i = b.begin; i < b.end; i++)
        for (int c = 0; c < 3; c++)
            sum[c] += q->entries[i].count * q->entries[i].c[c];
    for (int c = 0; c < 3; c++)
        q->means[q->mean_count][c] = (uint8_t)((sum[c] + total / 2) / total);
    q->mean_count++;
}

// Splits the box of the greatest length times root of pixels at its median, until there are `most`.
static void median_cut(quantizer* q, int most)
{
    static int (*const orders[])(const void*, const void*) = {red_order, green_order, blue_order};
    box boxes[MOST] = {{0, q->count}};
    int count = 1;
    for (; count < most; count++)
    {
        int best = 0, side = 0, best_side = 0;
        double score = -1.0;
        for (int i = 0; i < count; i++)
        {
            double length = boxes[i].end - boxes[i].begin < 2 ? -1.0 : (double)box_side(q, boxes[i], &side);
            double s = length < 0.0 ? -2.0 : length * length * (double)box_pixels(q, boxes[i]);
            if (s > score)
            {
                score = s;
                best = i;
                best_side = side;
            }
        }
        box* b = &boxes[best];
        qsort(q->entries + b->begin, (size_t)(b->end - b->begin), sizeof *q->entries, orders[best_side]);
        int64_t half = box_pixels(q, *b) / 2, sum = 0;
        int cut = b->begin;
        while (cut < b->end - 1 && (sum += q->entries[cut++].count) < half)
        {
        }
        boxes[count] = (box){cut, b->end};
        b->end = cut;
    }
    for (int i = 0; i < count; i++)
        box_mean(q, boxes[i]);
}

static int nearest(const uint8_t (*colors)[3], int count, const uint8_t* c)
{
    int best = 0, least = INT32_MAX;
    for (int i = 0; i < count; i++)
    {
        int d = 0;
        for (int k = 0; k < 3; k++)
            d += (colors[i][k] - c[k]) * (colors[i][k] - c[k]);
        if (d < least)
        {
            least = d;
            best = i;
        }
    }
    return best;
}

static void means_refine(quantizer* q)
{
    for (int round = 0; round < ROUNDS; round++)
    {
        int64_t sums[MOST][4] = {{0}};
        for (int i = 0; i < q->count; i++)
        {
            int64_t* sum = sums[nearest((const uint8_t(*)[3])q->means, q->mean_count, q->entries[i].c)];
            for (int c = 0; c < 3; c++)
                sum[c] += q->entries[i].count * q->entries[i].c[c];
            sum[3] += q->entries[i].count;
        }
        for (int i = 0; i < q->mean_count; i++)
            for (int c = 0; c < 3 && sums[i][3] > 0; c++)
                q->means[i][c] = (uint8_t)((sums[i][c] + sums[i][3] / 2) / sums[i][3]);
    }
}

// At most `colors` beside the background. False: no memory.
static bool palette_make(uint32_t* codes, int n, uint32_t background, int colors, ty_loop_palette* out)
{
    ty_loop_palette palette = {
        .background = {(uint8_t)(background >> 16), (uint8_t)(background >> 8), (uint8_t)background},
        .clear = background & TRANSPARENT};
    quantizer q = {0};
    if (!entries_take(&q, codes, n))
        return false;
    int most = colors + !palette.clear;
    if (q.count <= most)
        for (int i = 0; i < q.count; i++)
            memcpy(q.means[q.mean_count++], q.entries[i].c, 3);
    else
    {
        median_cut(&q, most);
        means_refine(&q);
    }
    int ground = palette.clear ? -1 : nearest((const uint8_t(*)[3])q.means, q.mean_count, palette.background);
    for (int i = 0; i < q.mean_count; i++)
        memcpy(i == ground ? palette.background : palette.colors[palette.count++], q.means[i], 3);
    ty_free(q.entries);
    *out = palette;
    return true;
}

// The nearest colour of the palette for each cell of out, by nearest pixels. One that follows itself is not sought
// again.
static void labels_find(const uint32_t* codes, int w, int h, ty_loop_labels* out)
{
    const ty_loop_palette* palette = &out->palette;
    uint8_t colors[MOST][3], *label = out->labels, last_label = TY_LOOP_BACKGROUND;
    uint32_t last = TRANSPARENT;
    memcpy(colors, palette->colors, sizeof palette->colors);
    if (!palette->clear)
        memcpy(colors[palette->count], palette->background, 3);
    for (int y = 0; y < out->height; y++)
        for (int x = 0; x < out->width; x++)
        {
            int64_t from_x = ((int64_t)2 * x + 1) * w / (2 * (int64_t)out->width);
            int64_t from_y = ((int64_t)2 * y + 1) * h / (2 * (int64_t)out->height);
            uint32_t code = codes[from_y * w + from_x];
            const uint8_t c[3] = {(uint8_t)(code >> 16), (uint8_t)(code >> 8), (uint8_t)code};
            if (code & TRANSPARENT)
                last_label = TY_LOOP_BACKGROUND;
            else if (code != last)
            {
                int k = nearest((const uint8_t(*)[3])colors, palette->count + !palette->clear, c);
                last_label = k == palette->count ? TY_LOOP_BACKGROUND : (uint8_t)k;
            }
            last = code;
            *label++ = last_label;
        }
}

ty_status ty_loop_labels_read(const char* path, const char* key, int colors, const int cells[2],
                              const ty_loop_palette* given, ty_loop_labels* out, ty_error* error)
{
    ty_image image;
    uint32_t* codes = NULL;
    *out = (ty_loop_labels){0};
    ty_status status = codes_read(path, key, &image, &codes, error);
    if (status != TY_OK)
        return status;
    int w = image.width, h = image.height;
    ty_image_term(&image);
    out->width = cells[0] ? cells[0] : w;
    out->height = cells[1] ? cells[1] : h;
    out->labels = TY_TRY_ALLOC(uint8_t, (size_t)out->width * (size_t)out->height);
    if (given)
        out->palette = *given;
    if (!out->labels ||
        (!given && !palette_make(codes, w * h, background_of(codes, w, h), colors ? colors : 1, &out->palette)))
        status = ty_error_set(error, TY_NO_MEMORY, "%s: no memory for %d x %d cells", key, out->width, out->height);
    if (status == TY_OK)
        labels_find(codes, w, h, out);
    ty_free(codes);
    if (status != TY_OK)
        ty_loop_labels_term(out);
    return status;
}

void ty_loop_labels_put(const ty_loop_labels* labels, int z, ty_loop_volume* v)
{
    const uint8_t* label = labels->labels;
    for (int y = 0; y < v->size[1]; y++)
        for (int x = 0; x < v->size[0]; x++, label++)
        {
            size_t at = ty_loop_voxel(v, x, y, z);
            bool inside = *label != TY_LOOP_BACKGROUND;
            v->values[at] = inside ? (uint16_t)TY_LOOP_ONE : 0;
            if (v->labels)
                v->labels[at] = inside ? *label : 0;
            if (v->tints && inside)
                memcpy(v->tints + 3 * at, v->palette.colors[*label], 3);
        }
}
