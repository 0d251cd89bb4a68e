// SPDX-License-Identifier: Apache-2.0
// Frames as the slices of one volume: numbers of four bytes, x fastest, then y from the top, then frames. A .nrrd says
// so itself, in a head of 128 bytes (Kindlmann's nearly raw raster data).
#include "loader.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum
{
    HEAD = 128 // bytes of a .nrrd before its numbers
};

static ty_status written(const ty_frame_volume* volume, bool good, ty_error* error)
{
    if (good)
        return TY_OK;
    return ty_error_set(error, TY_BAD_FILE, "%s: cannot write: %s", volume->path, strerror(errno));
}

static ty_status begin(ty_frame_volume* volume, const ty_exr* image, ty_error* error)
{
    char head[HEAD + 1];
    ty_status status = ty_atomic_begin(&volume->file, volume->path, error);
    if (status != TY_OK)
        return status;
    volume->begun = true;
    volume->width = ty_exr_width(image);
    volume->height = ty_exr_height(image);
    volume->fd = open(volume->file.temporary, O_WRONLY | O_CLOEXEC);
    if (volume->fd < 0 || strcmp(ty_path_extension(volume->path), "nrrd") != 0)
        return written(volume, volume->fd >= 0, error);
    volume->head = HEAD;
    int used = snprintf(head, sizeof head,
                        "NRRD0004\ntype: float\ndimension: 3\nsizes: %d %d %d\nendian: little\nencoding: raw\n#",
                        volume->width, volume->height, volume->depth);
    memset(head + used, ' ', (size_t)(HEAD - used)); // a comment as long as it takes
    memcpy(head + HEAD - 2, "\n\n", 2);
    return written(volume, ty_descriptor_write(volume->fd, head, HEAD), error);
}

// v, Y, or the light of R, G and B; NULL for what has none of them. *made is the caller's.
static const float* plane_of(const ty_exr* image, float** made)
{
    static const char *const alone[] = {"v", "Y"}, *const colors[] = {"R", "G", "B"};
    const float* rgb[3];
    for (int i = 0; i < 2; i++)
        if (ty_exr_find_channel(image, alone[i]))
            return ty_exr_find_channel(image, alone[i])->pixels;
    for (int i = 0; i < 3; i++)
    {
        const ty_exr_channel* channel = ty_exr_find_channel(image, colors[i]);
        rgb[i] = channel ? channel->pixels : NULL;
    }
    size_t size = (size_t)ty_exr_width(image) * (size_t)ty_exr_height(image);
    *made = rgb[0] && rgb[1] && rgb[2] ? TY_TRY_ALLOC(float, size) : NULL;
    for (size_t i = 0; *made && i < size; i++)
        (*made)[i] = ty_luminance((ty_rgb){rgb[0][i], rgb[1][i], rgb[2][i]});
    return *made;
}

ty_status ty_frame_volume_put(ty_frame_volume* volume, int frame, const ty_exr* image, ty_error* error)
{
    ty_status status = volume->begun ? TY_OK : begin(volume, image, error);
    if (status != TY_OK)
        return status;
    float* made = NULL;
    const float* plane = plane_of(image, &made);
    size_t slice = (size_t)volume->width * (size_t)volume->height * sizeof(float);
    off_t at = (off_t)(volume->head + (size_t)(frame - 1) * slice);
    if (!plane)
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for a slice of %d x %d", volume->width, volume->height);
    else
        status = written(volume, lseek(volume->fd, at, SEEK_SET) == at && ty_descriptor_write(volume->fd, plane, slice),
                         error);
    ty_free(made);
    return status;
}

ty_status ty_frame_volume_end(ty_frame_volume* volume, bool complete, ty_error* error)
{
    if (!volume->begun)
        return TY_OK;
    if (volume->fd >= 0)
        close(volume->fd);
    if (complete)
        return ty_atomic_commit(&volume->file, error);
    ty_atomic_abort(&volume->file);
    return TY_OK;
}
