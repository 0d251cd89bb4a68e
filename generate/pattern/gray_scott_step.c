// SPDX-License-Identifier: Apache-2.0
// Gray–Scott in time: which kernel, and what it has to look at in each row.
#include "gray_scott_field.h"
#include <string.h>
#include <tsuya/base/cpu.h>

stream_row_fn* gs_row_choose(ty_gray_scott_path path)
{
#if defined(__x86_64__)
    if (ty_cpu_has_avx512() && (path == TY_GRAY_SCOTT_BEST || path == TY_GRAY_SCOTT_AVX512))
        return gs_row_avx512;
    if (__builtin_cpu_supports("avx2") && (path == TY_GRAY_SCOTT_BEST || path == TY_GRAY_SCOTT_AVX2))
        return gs_row_avx2;
#endif
    return path == TY_GRAY_SCOTT_BEST || path == TY_GRAY_SCOTT_PORTABLE ? gs_row_portable : NULL;
}

bool ty_gray_scott_tune(ty_gray_scott* field, ty_gray_scott_tuning tuning)
{
    stream_row_fn* row = gs_row_choose(tuning.path);
    if (!row)
        return false;
    field->stream.row = row;
    field->stream.depth = tuning.depth;
    field->stream.strip = tuning.strip;
    field->stream.bands = tuning.bands;
    return true;
}

// Beyond the edges as the cells are: of the far side, or copies of the edge.
static void marks_around(ty_gray_scott* field)
{
    int w = field->def.width, h = field->def.height;
    for (int y = 0; y < h; y++)
    {
        uint8_t* marks = field->marks + gs_cell(field, y + 1);
        marks[-1] = marks[field->def.wrap_x ? w - 1 : 0];
        marks[w] = marks[field->def.wrap_x ? 0 : w - 1];
    }
    const uint8_t *first = field->marks + field->stream.stride, *last = field->marks + (size_t)h * field->stream.stride;
    memcpy(field->marks, field->def.wrap_y ? last : first, field->stream.stride);
    memcpy(field->marks + (size_t)(h + 1) * field->stream.stride, field->def.wrap_y ? first : last,
           field->stream.stride);
}

static uint64_t eight(const uint8_t* marks)
{
    uint64_t a;
    memcpy(&a, marks, sizeof a);
    return a;
}

// Of a group; what lies beyond the row's end counts as well, which may make it more careful than it need be.
static unsigned group_kind(const ty_gray_scott* field, const uint8_t* marks)
{
    uint64_t near = 0;
    for (ptrdiff_t row = -1; row <= 1; row++)
    {
        const uint8_t* at = marks + row * (ptrdiff_t)field->stream.stride;
        near |= eight(at - 1) | eight(at + 7) | eight(at + STREAM_GROUP + 1 - 8);
    }
    if (near & 0x8080808080808080u)
        return GS_RUN_BARRIERS;
    uint64_t all = marks[0] * 0x0101010101010101u;
    return (eight(marks) ^ all) | (eight(marks + 8) ^ all) ? GS_RUN_MIXED : marks[0] % TY_GRAY_SCOTT_MARKS;
}

// Kinds become kinds and lengths, from the end on. Short runs of a mark are mixed, so that they join others.
static void runs_join(uint16_t* runs, int groups)
{
    for (int g = 0, stop; g < groups; g = stop)
    {
        for (stop = g + 1; stop < groups && runs[stop] == runs[g];)
            stop++;
        if (runs[g] < TY_GRAY_SCOTT_MARKS && stop - g < GS_RUN_SHORT && groups > GS_RUN_SHORT)
            for (int i = g; i < stop; i++)
                runs[i] = GS_RUN_MIXED;
    }
    for (int g = groups - 1, length = 0; g >= 0; g--)
    {
        bool joins = g + 1 < groups && runs[g + 1] % GS_RUN_LENGTH == runs[g] && length < GS_RUN_MOST;
        length = joins ? length + 1 : 1;
        runs[g] = (uint16_t)(runs[g] + GS_RUN_LENGTH * length);
    }
}

static void rows_make(void* context, int64_t begin, int64_t end, int worker)
{
    const ty_gray_scott* field = context;
    int groups = (field->def.width + STREAM_GROUP - 1) / STREAM_GROUP;
    bool varied = field->feed || field->kill;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
    {
        const uint8_t* marks = field->marks + gs_cell(field, y + 1);
        uint16_t* runs = field->runs + (size_t)y * field->run_stride;
        for (int g = 0; g < groups; g++)
        {
            unsigned kind = group_kind(field, marks + g * STREAM_GROUP);
            if (varied)
                kind = kind == GS_RUN_BARRIERS ? GS_RUN_VARIED_BARRIERS : GS_RUN_VARIED;
            runs[g] = (uint16_t)kind;
        }
        runs_join(runs, groups);
    }
}

void gs_runs_make(ty_gray_scott* field, ty_workers* workers)
{
    enum
    {
        PIECE = 64 // rows
    };
    marks_around(field);
    ty_parallel_all(workers, field->def.height, PIECE, rows_make, field);
    field->runs_valid = true;
}

void ty_gray_scott_step(ty_gray_scott* field, int step_count, ty_workers* workers)
{
    if (!field->runs_valid)
        gs_runs_make(field, workers);
    (void)!stream_steps(&field->stream, step_count, workers); // who has cancelled knows it
}
