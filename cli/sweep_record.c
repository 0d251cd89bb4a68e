// SPDX-License-Identifier: Apache-2.0
// What a sweep knows of its cells, as JSON beside the pictures.
#include "sweep.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/memory.h>

enum
{
    MOST_BYTES = 1 << 28
};

static char* record_path(const ty_sweep_job* job)
{
    return ty_string_format("%s/sweep.json", job->folder);
}

static json_t* cell_json(const ty_sweep_job* job, int index)
{
    const ty_sweep_cell* cell = &job->cells[index];
    json_t *root = json_object(), *values = json_object();
    for (int a = 0; a < job->sweep.axis_count; a++)
    {
        json_object_set_new(values, job->sweep.axes[a].name,
                            ty_json_from_text(ty_sweep_value_at(&job->sweep, index, a)->text));
    }
    json_object_set_new(root, "name", json_string(cell->name));
    json_object_set_new(root, "values", values);
    json_object_set_new(root, "picture", cell->done ? ty_json_from_text(cell->output) : json_null());
    json_object_set_new(root, "command", ty_json_from_text(cell->command));
    json_object_set_new(root, "hash", json_string(cell->hash));
    json_object_set_new(root, "status", json_integer(cell->status));
    json_object_set_new(root, "fault", cell->fault[0] ? ty_json_from_text(cell->fault) : json_null());
    json_object_set_new(root, "seconds", cell->seconds >= 0.0 ? json_real(cell->seconds) : json_null());
    return root;
}

ty_status ty_sweep_record_write(const ty_sweep_job* job)
{
    json_t *root = json_object(), *cells = json_array(), *vary = json_array();
    for (int a = 0; a < job->sweep.axis_count; a++)
    {
        json_array_append_new(vary, ty_json_from_text(job->sweep.axes[a].argument));
    }
    for (int i = 0; i < job->sweep.cell_count; i++)
    {
        json_array_append_new(cells, cell_json(job, i));
    }
    json_object_set_new(root, "tsuya", json_string(TSUYA_VERSION));
    json_object_set_new(root, "scene", ty_json_from_text(job->arguments->positional[0]));
    json_object_set_new(root, "vary", vary);
    json_object_set_new(root, "zip", json_boolean(job->sweep.zip));
    json_object_set_new(root, "cells", cells);
    char* path = record_path(job);
    ty_status status = ty_json_write(path, root);
    ty_free(path);
    return status;
}

void ty_sweep_record_read(ty_sweep_job* job)
{
    ty_bytes bytes = {0};
    ty_error ignored;
    char* path = record_path(job);
    if (ty_file_exists(path) && ty_file_read(path, MOST_BYTES, &bytes, &ignored) == TY_OK)
    {
        job->record = json_loadb((const char*)bytes.data, bytes.size, 0, NULL);
    }
    ty_bytes_term(&bytes);
    ty_free(path);
}

double ty_sweep_record_seconds(const ty_sweep_job* job, const ty_sweep_cell* cell)
{
    size_t index;
    json_t* known;
    json_array_foreach(json_object_get(job->record, "cells"), index, known)
    {
        const char* name = json_string_value(json_object_get(known, "name"));
        const char* hash = json_string_value(json_object_get(known, "hash"));
        json_t* seconds = json_object_get(known, "seconds");
        if (name && hash && strcmp(name, cell->name) == 0 && strcmp(hash, cell->hash) == 0 && json_is_number(seconds))
        {
            return json_number_value(seconds);
        }
    }
    return -1.0;
}
