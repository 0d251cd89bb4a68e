// SPDX-License-Identifier: Apache-2.0
// The reference page: every table as Markdown.
#include "number.h"
#include <string.h>
#include <tsuya/scene/scene.h>

// A bar would end the cell.
static void add_cell(ty_text* out, const char* text)
{
    ty_text_add(out, " ");
    for (const char* c = text + strspn(text, " "); *c; ++c)
    {
        if (*c == '|')
            ty_text_add(out, "\\");
        ty_text_add_bytes(out, c, 1);
    }
    ty_text_add(out, " |");
}

static void add_accepted(ty_text* out, const ty_param* row)
{
    ty_text cell = {0};
    if (row->type == TY_PARAM_BRIEF_GROUP)
    {
        ty_param_expected(&row->group->params[0], &cell);
        ty_text_format(&cell, "; or a mapping of `%s`", row->group->name);
    }
    else if (row->group)
        ty_text_format(&cell, "%s of `%s`", row->type == TY_PARAM_LIST ? "a list" : "a mapping", row->group->name);
    else
        ty_param_expected(row, &cell);
    add_cell(out, cell.data);
    ty_text_term(&cell);
}

static void add_default(ty_text* out, const ty_param* row, const void* def)
{
    ty_text value = {0}, cell = {0};
    if (row->required)
        ty_text_add(&cell, "*required*");
    else
        ty_param_value_text(row, def, &value);
    if (value.size)
        ty_text_format(&cell, "`%s`", value.data);
    add_cell(out, cell.size ? cell.data : "");
    ty_text_term(&value);
    ty_text_term(&cell);
}

static void add_table(ty_text* out, const ty_param_table* table)
{
    void* def = ty_alloc(1, table->size);
    table->set_default(def);
    ty_text_format(out, "\n## %s\n\n%s\n\n", table->name, table->help);
    ty_text_add(out, "| key | accepted | default | meaning |\n|---|---|---|---|\n");
    for (int i = 0; i < table->count; ++i)
    {
        const ty_param* row = &table->params[i];
        ty_text_format(out, "| `%s` |", row->name);
        add_accepted(out, row);
        add_default(out, row, def);
        add_cell(out, row->help ? row->help : "");
        ty_text_add(out, "\n");
    }
    ty_free(def);
}

static const char FILES[] =
    "\n## A scene file\n\n"
    "| key | accepted | meaning |\n|---|---|---|\n"
    "| `tsuya` | `1` | the version of the format, *required* |\n"
    "| `include` | a file or a list of files | read first; mappings are merged, else this file wins (lists too) |\n"
    "| `search` | a list of folders | where files are looked for after the folder of the file that names them |\n"
    "| `overrides` | a text | which overrides the scene was made with; recipes inside pictures have it, it changes "
    "nothing |\n"
    "| `vars` | name: value | what `$name` stands for; `-D name=value` changes it |\n"
    "| `ocio` | the name of a file | OpenColorIO configuration |\n"
    "| `film`, `camera`, `render`, `timeline`, `turntable` | mappings | below |\n"
    "| `frame` | a number | the frame that a plain `render` makes: `timeline.start` if not given |\n"
    "| `assets` | name: `asset.mesh`, `asset.shape`, `asset.texture`, `asset.frames`, `asset.fill`, `asset.loop`, "
    "`asset.filter`, `asset.aggregate` or `asset.gltf` | what there is |\n"
    "| `materials` | name: { model: surface, cdrf, walk or bark, ... } | what it is made of |\n"
    "| `objects`, `lights` | lists of `object`, `light` | what is seen |\n\n"
    "A recipe has `tsuya: 1`, `kind:` (the name of its table: `aggregate`, `fill`, `filter`, `loop`, `roots`), `vars` "
    "and the keys of "
    "that "
    "table.\n\n"
    "`--set` takes the path of a value, with dots; an entry of a list goes by its number from 0 or by its name: "
    "`--set lights.0.radiance=3`, `--set objects.bowl.material=glaze`.\n\n"
    "**Values that change with time** are written `{ keys: { frame: value, ... } }`, anywhere in `camera`, "
    "`turntable`, "
    "`materials`, `lights` and `objects`, for numbers, lists of numbers (each by itself), colours (between them in "
    "ACEScg) and true or false (which hold). Beside `keys` may stand `interpolate`: `linear` (default), `smooth` "
    "(monotone cubic: no overshoot), `ease` (at rest at every key) or `hold`; and `before` and `after`, what is "
    "outside the keys: `hold` (default), `loop` (the last key's moment is the first's), `mirror`, `continue` (by the "
    "slope there) or `error`; `before` is as `after` if not given. A variable may be keyed, too. `assets`, `film` and "
    "`render` are the same for all frames.\n\n"
    "An input of a material is `value * (offset + scale * x)`, where x is what the texture or the instance's attribute "
    "gives; scale is 1 and offset 0 if not written. `texture` names an asset or a file; of a file, `wrap` says how it "
    "goes on outside 0..1: repeat, clamp or mirror, or [along u, along v]. An attribute is that of the instance, else "
    "that of "
    "the vertices (`color`: a PLY's red, green and blue, OBJ's and glTF's vertex colours); beside a texture it is one "
    "more factor. `product: rec709` multiplies the colours in that space instead of ACEScg, as their file may mean it. "
    "Packed aggregates bring the "
    "attributes `moisture` and `tint` (-1..1 around the mean) and `depth` (metres under the surface of the heap); "
    "every aggregate has `height` (0 for its lowest instance, 1 for its highest); "
    "`.ply` points bring every further property by its name.\n\n"
    "Beside `texture` may stand `channel`: `r`, `g`, `b`, `a` (1 where the file has none) or `luminance` in place of "
    "all, or the name of a further channel of the file (`v`, `matte.moss`), whose numbers are taken as they are: a "
    "fill "
    "that is named by its recipe makes what is asked for; "
    "`uv: { scale, offset, rotate }`: the texture is looked up at offset + rotated (scale * uv), degrees "
    "counter-clockwise; and `mapping: triplanar`, which needs no texture coordinates: the texture is projected along "
    "the "
    "axes of the object's own space (of each instance's), or with `space: world` of the scene's, `size` metres a "
    "repetition (0.1), the three directions reaching into one another by `blend` (0.3; 0..1). `mapping: planar` "
    "projects along y alone, from above, x to the right and -z up. Colours are converted from the space of the file: "
    "what the asset's `color_space` says, else "
    "what the file says, else sRGB for integers and linear Rec.709 for floats; numbers are taken as they are. Textures "
    "are converted once, into the folder of made assets; `--texture-cache` limits what of them is in memory.\n";

char* ty_params_markdown(void)
{
    int count = 0;
    const ty_param_table* const* tables = ty_scene_tables(&count);
    ty_text out = {0};
    ty_text_add(&out,
                "# Scene and recipe reference\n\n"
                "Written by `tsuya params --markdown` from the tables that the program reads files with.\n\n"
                "Units: metres unless a row says otherwise; angles in degrees. Colours are linear ACEScg unless a "
                "space is named; `'#rrggbb'` is sRGB. `$name` as a whole value is replaced by the variable `name`.\n");
    ty_text_add(&out, FILES);
    for (int i = 0; i < count; ++i)
        add_table(&out, tables[i]);
    return ty_text_take(&out);
}
