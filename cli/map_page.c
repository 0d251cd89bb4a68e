// SPDX-License-Identifier: Apache-2.0
// The page of a map of feed and kill: the picture and the numbers within the page of cli/page/map.html.
#include "fill_pages.h"
#include "markup.h"
#include "picture.h"
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/color.h>

extern const char ty_map_html[];

typedef struct map_page
{
    ty_bytes picture; // PNG
    const char* data; // JSON that the generator wrote
} map_page;

static ty_status encode(const ty_exr* frame, ty_bytes* out, ty_error* error)
{
    const ty_exr_channel* grey = ty_exr_find_channel(frame, "Y");
    const ty_exr_channel* planes[3] = {ty_exr_find_channel(frame, "R"), ty_exr_find_channel(frame, "G"),
                                       ty_exr_find_channel(frame, "B")};
    if (!grey && !(planes[0] && planes[1] && planes[2]))
        return ty_error_set(error, TY_BAD_INPUT, "the frame has no colours");
    ty_image image = {.width = ty_exr_width(frame), .height = ty_exr_height(frame), .channels = 3};
    size_t size = (size_t)image.width * (size_t)image.height;
    image.pixels = TY_TRY_ALLOC(float, 3 * size);
    if (!image.pixels)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a picture of %d x %d", image.width, image.height);
    for (size_t i = 0; i < 3 * size; i++)
        image.pixels[i] = ((const float*)(grey ? grey : planes[i % 3])->pixels)[i / 3];
    ty_color* color = NULL;
    ty_status status = ty_color_create(NULL, &color, error);
    if (status == TY_OK)
        status = ty_color_convert(color, "ACEScg", "srgb_texture", image.pixels, (int)size, 3, error);
    if (status == TY_OK)
        status = ty_image_encode("map.png", &image, 8, out, error);
    ty_color_destroy(color);
    ty_image_term(&image);
    return status;
}

// The template with what its marks stand for: the picture and the data.
static ty_status put_page(FILE* file, const void* context, ty_error* error)
{
    static const char picture[] = "@PICTURE@", data[] = "@DATA@";
    const map_page* page = context;
    const char* at = ty_map_html;
    (void)error;
    for (const char* mark; (mark = strchr(at, '@'));)
    {
        const bool is_picture = strncmp(mark, picture, strlen(picture)) == 0;
        const bool is_data = strncmp(mark, data, strlen(data)) == 0;
        fwrite(at, 1, (size_t)(mark - at), file);
        at = mark + (is_picture ? strlen(picture) : is_data ? strlen(data) : 1);
        if (is_picture)
            ty_markup_base64(file, &page->picture);
        else
            fputs(is_data ? page->data : "@", file);
    }
    fputs(at, file);
    return TY_OK;
}

ty_status ty_map_page_write(const char* path, const char* pattern, ty_error* error)
{
    char name[TY_PATH_MAX];
    ty_frame_numbers frames;
    ty_exr* frame = NULL;
    map_page page = {0};
    ty_status status = ty_frame_numbers_find(pattern, &frames, error);
    if (status != TY_OK)
        return status;
    ty_path_frame(pattern, frames.numbers[frames.count - 1], name);
    ty_frame_numbers_term(&frames);
    status = ty_exr_read(name, &frame, error);
    if (status != TY_OK)
        return status;
    const ty_exr_attribute* data = ty_exr_find_attribute(frame, "tsuya/map");
    if (!data || data->type != TY_EXR_STRING || strchr(data->text, '<'))
        status = ty_error_set(error, TY_BAD_INPUT, "map: the recipe has none; a page shows one");
    else
        page.data = data->text;
    if (status == TY_OK)
        status = encode(frame, &page.picture, error);
    if (status == TY_OK)
        status = ty_output_write(path, put_page, &page, error);
    ty_bytes_term(&page.picture);
    ty_exr_destroy(frame);
    return status;
}
