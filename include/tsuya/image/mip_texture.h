// SPDX-License-Identifier: Apache-2.0
// Filtered and animated textures: each file once converted to a tiled, MIP-mapped half file in ACEScg (or raw), of
// which only the tiles that lookups need are in memory.
#pragma once
#include <stdint.h>
#include <tsuya/base/math.h>
#include <tsuya/base/status.h>
#include <tsuya/image/color.h>
#include <tsuya/image/texture.h>

typedef struct ty_mip_cache ty_mip_cache;     // opaque: the tiles in memory, and where converted files are kept
typedef struct ty_mip_texture ty_mip_texture; // opaque: one image, or a sequence of them

typedef struct ty_mip_cache_def
{
    const char* folder;    // of converted files; NULL or not writable: temporary files without a name, and a warning
    uint64_t memory_bytes; // of tiles at a time, at least 16 MiB
} ty_mip_cache_def;

typedef struct ty_mip_cache_stats
{
    int files_converted, files_found; // since the beginning; found = already converted by an earlier run
    double convert_seconds;
    uint64_t bytes_now;              // of tiles in memory
    uint64_t tiles_read, tiles_peak; // from files; in memory at a time
    uint64_t bytes_read;
} ty_mip_cache_stats;

#define TY_MIP_CACHE_BYTES ((uint64_t)1 << 30) // the usual limit

// color is borrowed. The cache outlives its textures.
TY_CHECKED ty_status ty_mip_cache_create(const ty_mip_cache_def* def, const ty_color* color, ty_mip_cache** out,
                                         ty_error* error);
void ty_mip_cache_destroy(ty_mip_cache* cache); // NULL is allowed
void ty_mip_cache_get_stats(const ty_mip_cache* cache, ty_mip_cache_stats* out);
// Lookups cannot fail: a tile that could not be read was black. TY_BAD_FILE with the reason if there were any.
TY_CHECKED ty_status ty_mip_cache_check(ty_mip_cache* cache, ty_error* error);

// What a sequence shows before its first and after its last frame.
typedef enum ty_sequence_end
{
    TY_SEQUENCE_STOP, // nothing: such a time is an error
    TY_SEQUENCE_HOLD,
    TY_SEQUENCE_LOOP,   // the first follows the last
    TY_SEQUENCE_MIRROR, // back and forth; the end frames are shown once
} ty_sequence_end;

typedef struct ty_mip_texture_def
{
    const char* path;        // a file, or a pattern ("fill.####.exr"); borrowed during create
    const char* color_space; // NULL = guess, "raw" = numbers, untouched
    const char* channel;     // the only one that counts, as grey numbers, untouched ("v"); NULL = the picture
    ty_wrap wrap[2];         // outside 0..1 along u, and along v
    // Sequences: frame `first` is shown from `start` seconds on, each for 1 / fps seconds.
    int first, last; // numbers of frames, all of which must be there; last < first: those that are there
    float fps;       // > 0
    float start;     // s
    int end;         // ty_sequence_end
    bool blend;      // between one frame and the next; else one frame stands until the next
} ty_mip_texture_def;

ty_mip_texture_def ty_mip_texture_def_default(void);

// Copies def. Finds the files but looks into none: ty_mip_texture_set_time does. A pattern without frames, or with gaps
// (all named), is TY_BAD_FILE.
TY_CHECKED ty_status ty_mip_texture_create(ty_mip_cache* cache, const ty_mip_texture_def* def, ty_mip_texture** out,
                                           ty_error* error);
void ty_mip_texture_destroy(ty_mip_texture* texture); // NULL is allowed

int ty_mip_texture_frame_count(const ty_mip_texture* texture); // 1 for a single image

// Reads every file to the end without keeping anything: they are images, and of one size. For `check`.
TY_CHECKED ty_status ty_mip_texture_verify(const ty_mip_texture* texture, ty_error* error);

// Picks the image, or the two images and their weights, that lookups see; converts what is not converted yet, and
// touches nothing that stays as it is. Not while lookups run. On failure the texture shows what it did before. A time
// outside of a sequence that stops is TY_BAD_INPUT.
TY_CHECKED ty_status ty_mip_texture_set_time(ty_mip_texture* texture, double seconds, ty_error* error);

// Which frames (counted from 0) a time shows, and the weight of the second; false = outside of a sequence that stops.
bool ty_sequence_at(const ty_mip_texture_def* def, int frame_count, double seconds, int frame[2], float* weight);

// What a lookup gives: RGB and alpha; grey is repeated, alpha 1 where the file has none.
typedef struct ty_texel
{
    ty_rgb rgb;
    float alpha;
} ty_texel;

// At uv, v = 0 being the bottom row, averaged over the parallelogram of du and dv (uv across the whole footprint; zero
// = bilinear at the point). Trilinear between reductions, with up to 16 probes along the longer axis. Any thread.
// Depends on nothing but the arguments and the time set.
ty_texel ty_mip_texture_sample(const ty_mip_texture* texture, ty_vec2 uv, ty_vec2 du, ty_vec2 dv);
