// SPDX-License-Identifier: Apache-2.0
// Words and pictures of a sweep's cells, for its sheet and its report.
#include "sweep_view.h"
#include "picture.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/memory.h>

enum
{
    MOST_COLUMNS = 8 // of cells that flow
};

ty_sweep_layout ty_sweep_layout_of(const ty_sweep* sweep)
{
    if (sweep->axis_count > 1 && !sweep->zip)
    {
        int columns = sweep->axes[sweep->axis_count - 1].count;
        return (ty_sweep_layout){sweep->cell_count / columns, columns, true};
    }
    int columns = 1, count = sweep->cell_count;
    while (columns < MOST_COLUMNS && columns * columns < count)
    {
        columns++;
    }
    columns = count <= 5 ? count : columns;
    return (ty_sweep_layout){(count + columns - 1) / columns, columns, false};
}

// The last step of a path says it, if no other axis ends alike.
static const char* short_name(const ty_sweep* sweep, int axis)
{
    const char* name = sweep->axes[axis].name;
    const char* dot = strrchr(name, '.');
    const char* last = dot ? dot + 1 : name;
    for (int a = 0; a < sweep->axis_count; a++)
    {
        const char* other = strrchr(sweep->axes[a].name, '.');
        if (a != axis && strcmp(other ? other + 1 : sweep->axes[a].name, last) == 0)
        {
            return name;
        }
    }
    return last;
}

static void append(char out[TY_SWEEP_LABEL_MAX], const char* between, const char* text)
{
    size_t used = strlen(out);
    snprintf(out + used, TY_SWEEP_LABEL_MAX - used, "%s%s", used ? between : "", text);
}

void ty_sweep_row_title(const ty_sweep_job* job, const ty_sweep_layout* layout, char out[TY_SWEEP_LABEL_MAX])
{
    out[0] = '\0';
    for (int a = 0; a + 1 < job->sweep.axis_count && layout->grid; a++)
    {
        append(out, " / ", short_name(&job->sweep, a));
    }
}

void ty_sweep_column_title(const ty_sweep_job* job, const ty_sweep_layout* layout, char out[TY_SWEEP_LABEL_MAX])
{
    snprintf(out, TY_SWEEP_LABEL_MAX, "%s", layout->grid ? short_name(&job->sweep, job->sweep.axis_count - 1) : "");
}

void ty_sweep_row_label(const ty_sweep_job* job, const ty_sweep_layout* layout, int row, char out[TY_SWEEP_LABEL_MAX])
{
    out[0] = '\0';
    for (int a = 0; a + 1 < job->sweep.axis_count && layout->grid; a++)
    {
        append(out, " / ", ty_sweep_value_at(&job->sweep, row * layout->columns, a)->text);
    }
}

void ty_sweep_column_label(const ty_sweep_job* job, const ty_sweep_layout* layout, int column,
                           char out[TY_SWEEP_LABEL_MAX])
{
    int last = job->sweep.axis_count - 1;
    snprintf(out, TY_SWEEP_LABEL_MAX, "%s", layout->grid ? ty_sweep_value_at(&job->sweep, column, last)->text : "");
}

void ty_sweep_cell_label(const ty_sweep_job* job, int cell, char out[TY_SWEEP_LABEL_MAX])
{
    out[0] = '\0';
    for (int a = 0; a < job->sweep.axis_count; a++)
    {
        append(out, ", ", short_name(&job->sweep, a));
        append(out, " ", ty_sweep_value_at(&job->sweep, cell, a)->text);
    }
}

void ty_sweep_fixed(const ty_sweep_job* job, char out[TY_SWEEP_LABEL_MAX])
{
    snprintf(out, TY_SWEEP_LABEL_MAX, "%s", job->base.options.quick ? "quick" : "");
    for (int i = 0; i < job->base.options.variable_count; i++)
    {
        append(out, "   ", job->base.variables[i]);
    }
    for (int i = 0; i < job->base.options.set_count; i++)
    {
        append(out, "   ", job->base.sets[i]);
    }
}

ty_status ty_sweep_picture(const ty_sweep_job* job, int cell, ty_image* out, ty_error* error)
{
    static ty_layer layers[TY_LAYERS_MAX]; // 20 kB, and commands run on one thread
    ty_picture picture;
    *out = (ty_image){0};
    ty_status status = ty_picture_read(job->cells[cell].output, &picture, error);
    if (status == TY_OK)
    {
        int count = ty_picture_layers(&picture, layers);
        status = count > 0 && ty_layer_is_color(&layers[0])
                     ? ty_picture_take(&picture, &layers[0], picture.exr->data_window, out, error)
                     : ty_error_set_at(error, TY_BAD_FILE, picture.path, 0, 0, "no R, G and B");
    }
    ty_picture_term(&picture);
    return status;
}
