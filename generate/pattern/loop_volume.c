// SPDX-License-Identifier: Apache-2.0
// Memory of volumes, and single places in them.
#include "loop_volume.h"
#include <string.h>
#include <tsuya/base/cpu.h>
#include <tsuya/base/memory.h>

ty_status ty_loop_size_check(const int size[3], ty_error* error)
{
    for (int k = 0; k < 3; k++)
        if (size[k] < 1 || size[k] > TY_LOOP_DEPTH)
            return ty_error_set(error, TY_BAD_INPUT, "volume: %d x %d x %d voxels; each side has 1..%d", size[0],
                                size[1], size[2], TY_LOOP_DEPTH);
    if (((size_t)size[0] + 1) * ((size_t)size[1] + 1) * ((size_t)size[2] + 1) > INT32_MAX) // indices of the kernels
        return ty_error_set(error, TY_BAD_INPUT, "volume: %d x %d x %d voxels; at most 2147483647 in all", size[0],
                            size[1], size[2]);
    return TY_OK;
}

ty_status ty_loop_volume_create(const int size[3], bool colored, bool blended, ty_loop_volume* out, ty_error* error)
{
    *out = (ty_loop_volume){.row = (size_t)size[0] + 1};
    memcpy(out->size, size, sizeof out->size);
    ty_status status = ty_loop_size_check(size, error);
    if (status != TY_OK)
        return status;
    out->slice = out->row * ((size_t)size[1] + 1);
    out->count = out->slice * ((size_t)size[2] + 1);
    out->values = TY_TRY_ALLOC(uint16_t, out->count);
    out->labels = colored && !blended ? TY_TRY_ALLOC(uint8_t, out->count) : NULL;
    out->tints = colored && blended ? TY_TRY_ALLOC(uint8_t, 3 * out->count) : NULL;
    if (out->values && (!colored || out->labels || out->tints))
        return TY_OK;
    ty_loop_volume_term(out);
    return ty_error_set(error, TY_NO_MEMORY, "no memory for %d x %d x %d voxels", size[0], size[1], size[2]);
}

void ty_loop_volume_term(ty_loop_volume* volume)
{
    ty_free(volume->values);
    ty_free(volume->labels);
    ty_free(volume->tints);
    *volume = (ty_loop_volume){0};
}

void ty_loop_volume_copy(ty_loop_volume* volume, size_t to, size_t from, size_t count)
{
    memcpy(volume->values + to, volume->values + from, count * sizeof *volume->values);
    if (volume->labels)
        memcpy(volume->labels + to, volume->labels + from, count);
    if (volume->tints)
        memcpy(volume->tints + 3 * to, volume->tints + 3 * from, 3 * count);
}

void ty_loop_volume_close(ty_loop_volume* volume)
{
    int from[3];
    for (int k = 0; k < 3; k++)
        from[k] = volume->wrap[k] ? 0 : volume->size[k] - 1;
    for (int z = 0; z < volume->size[2]; z++)
    {
        for (int y = 0; y < volume->size[1]; y++)
            ty_loop_volume_copy(volume, ty_loop_voxel(volume, volume->size[0], y, z),
                                ty_loop_voxel(volume, from[0], y, z), 1);
        ty_loop_volume_copy(volume, ty_loop_voxel(volume, 0, volume->size[1], z), ty_loop_voxel(volume, 0, from[1], z),
                            volume->row);
    }
    ty_loop_volume_copy(volume, ty_loop_voxel(volume, 0, 0, volume->size[2]), ty_loop_voxel(volume, 0, 0, from[2]),
                        volume->slice);
}

ty_loop_sample_fn* ty_loop_sampler(void)
{
    return ty_cpu_has_avx512() ? ty_loop_sample_avx512 : ty_loop_sample_base;
}

int ty_loop_label_of(const ty_loop_volume* volume, const ty_loop_corners* corners)
{
    float sums[TY_LOOP_COLORS] = {0.0f};
    int first = volume->labels[corners->at[0]], most = 0;
    bool one = true;
    for (int c = 1; c < 8; c++)
        one &= volume->labels[corners->at[c]] == first;
    if (one)
        return first;
    for (int c = 0; c < 8; c++)
        sums[volume->labels[corners->at[c]]] += corners->weight[c] * (float)volume->values[corners->at[c]];
    for (int k = 1; k < TY_LOOP_COLORS; k++)
        if (sums[k] > sums[most])
            most = k;
    return most;
}

void ty_loop_tint_of(const ty_loop_volume* v, const ty_loop_corners* corners, uint8_t out[3])
{
    float sum[3] = {0.0f, 0.0f, 0.0f}, total = 0.0f;
    for (int c = 0; c < 8; c++)
    {
        float weight = corners->weight[c] * (float)v->values[corners->at[c]];
        total += weight;
        for (int k = 0; k < 3; k++)
            sum[k] += weight * (float)v->tints[3 * corners->at[c] + (size_t)k];
    }
    for (int k = 0; k < 3 && total > 0.0f; k++)
        out[k] = (uint8_t)(sum[k] / total + 0.5f);
}

ty_status ty_loop_part_error(ty_status status, int index, const char* group, ty_error* error)
{
    if (status != TY_BAD_INPUT || !error || error->file[0])
        return status;
    return ty_error_set(error, status, "volume[%d].%s.%.900s", index, group, error->text);
}

ty_status ty_loop_range(const ty_loop_part* part, int index, float high, float* low, float* scale, ty_error* error)
{
    bool given = part->range[0] != 0.0f || part->range[1] != 0.0f;
    if (given && part->range[0] == part->range[1])
        return ty_error_set(error, TY_BAD_INPUT, "volume[%d].range: [%g, %g]; two different numbers", index,
                            (double)part->range[0], (double)part->range[1]);
    *low = given ? part->range[0] : 0.0f;
    *scale = 1.0f / ((given ? part->range[1] : high) - *low);
    return TY_OK;
}
