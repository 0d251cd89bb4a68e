// SPDX-License-Identifier: Apache-2.0
// Point clouds: every scalar column of the vertex element.
#include "ply.h"
#include <string.h>

static ty_status read_columns(ply_file* file, const ply_element* element, ply_points* out)
{
    for (uint64_t item = 0; item < element->count; item++)
    {
        for (int i = 0; i < element->property_count; i++)
        {
            double value;
            ty_status status = ply_read_value(file, element->properties[i].type, &value);
            if (status != TY_OK)
            {
                return status;
            }
            out->columns[i][item] = (float)value;
        }
    }
    return TY_OK;
}

static ty_status read_vertices(ply_file* file, const ply_element* element, ply_points* out)
{
    ty_status status = ply_check_room(file, element);
    out->count = element->count;
    for (int i = 0; i < element->property_count && status == TY_OK; i++)
    {
        if (element->properties[i].count_type != PLY_NO_TYPE)
        {
            return ply_fail(file, "vertex property '%s' is a list", element->properties[i].name);
        }
        memcpy(out->names[i], element->properties[i].name, PLY_NAME_SIZE);
        out->columns[i] = TY_TRY_ALLOC(float, element->count);
        out->column_count++;
        status = out->columns[i] ? TY_OK : ty_error_set(file->error, TY_NO_MEMORY, "%s: too many points", file->name);
    }
    return status == TY_OK ? read_columns(file, element, out) : status;
}

ty_status ply_read_points(const char* name, const void* bytes, size_t size, ply_points* out, ty_error* error)
{
    memset(out, 0, sizeof *out);
    ply_file file;
    ty_status status = ply_open(&file, name, bytes, size, error);
    for (int i = 0; i < file.element_count && status == TY_OK; i++)
    {
        const ply_element* element = &file.elements[i];
        if (strcmp(element->name, "vertex") == 0)
        {
            status = read_vertices(&file, element, out);
            if (status != TY_OK)
            {
                ply_points_term(out);
            }
            return status;
        }
        status = ply_check_room(&file, element);
        status = status == TY_OK ? ply_skip_element(&file, element) : status;
    }
    return status == TY_OK ? ply_fail(&file, "there is no element vertex") : status;
}

void ply_points_term(ply_points* points)
{
    for (int i = 0; i < points->column_count; i++)
    {
        ty_free(points->columns[i]);
    }
    memset(points, 0, sizeof *points);
}

const float* ply_points_column(const ply_points* points, const char* name)
{
    for (int i = 0; i < points->column_count; i++)
    {
        if (strcmp(points->names[i], name) == 0)
        {
            return points->columns[i];
        }
    }
    return NULL;
}
