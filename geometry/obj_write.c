// SPDX-License-Identifier: Apache-2.0
// Meshes as OBJ text.
#include <tsuya/base/file.h>
#include <tsuya/base/sink.h>
#include <tsuya/geometry/aggregate_export.h>

static void put_line(ty_sink* text, const char* key, const float* values, int count)
{
    ty_sink_format(text, "%s", key);
    for (int i = 0; i < count; i++)
    {
        ty_sink_put(text, " ", 1);
        ty_sink_float(text, values[i]);
    }
    ty_sink_put(text, "\n", 1);
}

static void put_faces(ty_sink* text, const ty_mesh* mesh, int slot)
{
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        if (mesh->slots && mesh->slots[t] != slot)
            continue;
        ty_sink_put(text, "f", 1);
        for (int k = 0; k < 3; k++)
        {
            uint32_t v = mesh->triangles[t][k] + 1; // counted from 1
            if (mesh->uvs)
                ty_sink_format(text, " %u/%u/%u", v, v, v);
            else
                ty_sink_format(text, " %u//%u", v, v);
        }
        ty_sink_put(text, "\n", 1);
    }
}

ty_status ty_obj_write(const char* path, const ty_mesh* mesh, ty_error* error)
{
    ty_sink text = {0};
    ty_sink_format(&text, "# tsuya: metres, y up\no mesh\n");
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        put_line(&text, "v", &mesh->positions[i].x, 3);
    for (uint32_t i = 0; mesh->uvs && i < mesh->vertex_count; i++)
        put_line(&text, "vt", &mesh->uvs[i].x, 2);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        put_line(&text, "vn", &mesh->normals[i].x, 3);
    for (int s = 0; s < (mesh->slots ? mesh->slot_count : 1); s++)
    {
        if (s < mesh->slot_count && mesh->slot_names[s][0])
            ty_sink_format(&text, "usemtl %.200s\n", mesh->slot_names[s]);
        put_faces(&text, mesh, s);
    }
    ty_status status = ty_file_write(path, text.bytes, text.size, error);
    ty_sink_term(&text);
    return status;
}
