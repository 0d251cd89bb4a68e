// SPDX-License-Identifier: Apache-2.0
// Built-in shapes: their parameters, what sizes are possible, and which file makes which.
#include "shape_build.h"

ty_shape_def ty_shape_def_default(void)
{
    return (ty_shape_def){
        .kind = TY_SHAPE_SPHERE,
        .radius = 0.06f,
        .size = {0.05f, 0.05f, 0.05f},
        .tube = 0.02f,
        .curve = 2.8f,
        .rounding = 0.0f,
        .relief = 0.15f,
        .variant = 1,
        .divisions = 64,
    };
}

static float or_else(float length, double derived)
{
    return length == 0.0f ? (float)derived : length;
}

ty_shape_def ty_shape_def_complete(const ty_shape_def* def)
{
    ty_shape_def c = *def;
    c.height = or_else(c.height, (double)c.radius);
    c.thickness = or_else(c.thickness, fmin(0.05 * (double)c.radius, 0.1 * (double)c.height));
    c.foot_radius = or_else(c.foot_radius, 0.4 * (double)c.radius);
    c.foot_height = or_else(c.foot_height, 7.0 / 60.0 * (double)c.height);
    return c;
}

static void set_default(void* def)
{
    *(ty_shape_def*)def = ty_shape_def_default();
}

static const char* const kinds[] = {"sphere", "ellipsoid", "box",   "cylinder", "torus", "plane", "disc", "bowl",
                                    "dome",   "sweep",     "stone", "lathe",    "block", "tube",  NULL};

#define LENGTH(field, help)                                                                                            \
    {                                                                                                                  \
#field, TY_PARAM_FLOAT, "m", 0, 1e4, NULL, NULL, offsetof(ty_shape_def, field), help, false                    \
    }

static void set_point_default(void* def)
{
    *(ty_shape_point*)def = (ty_shape_point){0};
}

static const ty_param point_rows[] = {
    {"at", TY_PARAM_FLOAT2, "m", -1e4, 1e4, NULL, NULL, offsetof(ty_shape_point, at), "[radius, height]", true},
    {"rounding", TY_PARAM_FLOAT, "m", 0, 1e4, NULL, NULL, offsetof(ty_shape_point, rounding),
     "radius of an arc in place of the corner", false},
    {"smooth", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_shape_point, smooth),
     "no corner: a curve goes through the point", false},
};

static const ty_param_table point_table = {
    "asset.shape.profile",     "A point of a lathe's profile.", sizeof(ty_shape_point), set_point_default, point_rows,
    TY_PARAM_COUNT(point_rows)};

static const ty_param rows[] = {
    {"shape", TY_PARAM_ENUM, "", 0, 0, kinds, NULL, offsetof(ty_shape_def, kind), "which shape", true},
    LENGTH(radius, "sphere, cylinder, disc, dome, tube; torus: to the tube's centre; bowl: outside of the rim"),
    {"size", TY_PARAM_FLOAT3, "m", 0, 1e4, NULL, NULL, offsetof(ty_shape_def, size),
     "ellipsoid, stone: semi-axes; box, block, plane: half extents; sweep: half width, wall height, half depth", false},
    LENGTH(height, "cylinder, bowl, dome; 0 = the radius"),
    LENGTH(tube, "torus: radius of the tube"),
    LENGTH(thickness, "bowl: of the wall; 0 = .05 of the radius, at most .1 of the height"),
    LENGTH(foot_radius, "bowl: outside of the foot ring; 0 = .4 of the radius"),
    LENGTH(foot_height, "bowl: of the foot ring; 0 = 7/60 of the height"),
    {"curve", TY_PARAM_FLOAT, "", 1, 12, NULL, NULL, offsetof(ty_shape_def, curve),
     "bowl profile: 1 = cone, 2 = parabola, higher = fuller", false},
    LENGTH(rounding, "box, cylinder: radius of the edges; sweep: of the bend"),
    {"relief", TY_PARAM_FLOAT, "", 0, 0.5, NULL, NULL, offsetof(ty_shape_def, relief),
     "stone: faces and bumps against its size, 0 = an ellipsoid; block: bumps and worn edges", false},
    {"variant", TY_PARAM_INT, "", 0, 1000000, NULL, NULL, offsetof(ty_shape_def, variant), "stone, block: which one",
     false},
    {"profile", TY_PARAM_LIST, "", 0, 0, NULL, &point_table, offsetof(ty_shape_def, profile),
     "lathe: points turned about y; closed from axis to axis, or when it ends where it began", false},
    {"points", TY_PARAM_POINTS, "m", -1e4, 1e4, NULL, NULL, offsetof(ty_shape_def, points),
     "tube: a smooth curve goes through them, straight on at its ends", false},
    {"divisions", TY_PARAM_INT, "", 8, 4096, NULL, NULL, offsetof(ty_shape_def, divisions),
     "segments around; the other direction follows the shape", false},
};

static const ty_param_table table = {
    "asset.shape",       "A built-in shape as a mesh; y is up.", sizeof(ty_shape_def), set_default, rows,
    TY_PARAM_COUNT(rows)};

const ty_param_table* ty_shape_params(void)
{
    return &table;
}

static ty_status check_length(const char* name, float value, ty_error* error)
{
    // Beyond these the squares and cubes of float coordinates leave their range.
    if (value >= 1e-6f && value <= 1e4f)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "%s: %g m: must be within 1e-06 .. 10000 m", name, (double)value);
}

static ty_status check_size(const ty_shape_def* def, bool x, bool y, bool z, ty_error* error)
{
    ty_status status = x ? check_length("size (x)", def->size.x, error) : TY_OK;
    if (status == TY_OK && y)
        status = check_length("size (y)", def->size.y, error);
    if (status == TY_OK && z)
        status = check_length("size (z)", def->size.z, error);
    return status;
}

// 0 is allowed unless needed.
static ty_status check_rounding(const ty_shape_def* def, float most, bool needed, ty_error* error)
{
    if (def->rounding == 0.0f && !needed)
        return TY_OK;
    if (def->rounding >= 1e-6f && def->rounding <= most)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "rounding: %g m: must be %s1e-06 .. %g m for these sizes",
                        (double)def->rounding, needed ? "within " : "0 or within ", (double)most);
}

static ty_status check_torus(const ty_shape_def* def, ty_error* error)
{
    ty_status status = check_length("tube", def->tube, error);
    if (status == TY_OK && !(def->tube < def->radius))
        status = ty_error_set(error, TY_BAD_INPUT, "tube: %g m: must be smaller than the radius, %g m",
                              (double)def->tube, (double)def->radius);
    return status;
}

static ty_status check_bowl(const ty_shape_def* def, ty_error* error)
{
    ty_status status = check_length("height", def->height, error);
    if (status == TY_OK)
        status = check_length("thickness", def->thickness, error);
    if (status == TY_OK)
        status = check_length("foot_radius", def->foot_radius, error);
    if (status == TY_OK)
        status = check_length("foot_height", def->foot_height, error);
    if (status == TY_OK && !(def->curve >= 1.0f && def->curve <= 12.0f))
        status = ty_error_set(error, TY_BAD_INPUT, "curve: %g: must be within 1 .. 12", (double)def->curve);
    return status == TY_OK ? ty_shape_check_bowl(def, error) : status;
}

static ty_status check_extents(const ty_shape_def* def, ty_error* error)
{
    ty_status status = TY_OK;
    ty_vec3 s = def->size;
    switch ((ty_shape_kind)def->kind)
    {
    case TY_SHAPE_ELLIPSOID:
    case TY_SHAPE_STONE:
    case TY_SHAPE_BLOCK:
        return check_size(def, true, true, true, error);
    case TY_SHAPE_BOX:
        status = check_size(def, true, true, true, error);
        return status == TY_OK ? check_rounding(def, ty_min(s.x, ty_min(s.y, s.z)), false, error) : status;
    case TY_SHAPE_PLANE:
        return check_size(def, true, false, true, error);
    case TY_SHAPE_SWEEP:
        status = check_size(def, true, true, true, error);
        return status == TY_OK ? check_rounding(def, ty_min(s.y, 2.0f * s.z), true, error) : status;
    case TY_SHAPE_CYLINDER:
    case TY_SHAPE_DOME:
        status = check_length("height", def->height, error);
        if (status == TY_OK && def->kind == TY_SHAPE_CYLINDER)
            status = check_rounding(def, ty_min(def->radius, 0.5f * def->height), false, error);
        return status;
    case TY_SHAPE_TORUS:
        return check_torus(def, error);
    case TY_SHAPE_BOWL:
        return check_bowl(def, error);
    case TY_SHAPE_LATHE:
        return ty_shape_check_lathe(def, error);
    case TY_SHAPE_TUBE:
        return ty_shape_check_tube(def, error);
    case TY_SHAPE_SPHERE:
    case TY_SHAPE_DISC:
        break;
    }
    return TY_OK;
}

static ty_status check_def(const ty_shape_def* def, ty_error* error)
{
    if (def->kind < 0 || def->kind > TY_SHAPE_TUBE)
        return ty_error_set(error, TY_BAD_INPUT, "shape: %d: no such shape", def->kind);
    if (def->divisions < 8 || def->divisions > 4096)
        return ty_error_set(error, TY_BAD_INPUT, "divisions: %d: must be within 8 .. 4096", def->divisions);
    bool has_radius = def->kind != TY_SHAPE_ELLIPSOID && def->kind != TY_SHAPE_BOX && def->kind != TY_SHAPE_PLANE &&
                      def->kind != TY_SHAPE_SWEEP && def->kind != TY_SHAPE_STONE && def->kind != TY_SHAPE_LATHE &&
                      def->kind != TY_SHAPE_BLOCK;
    ty_status status = has_radius ? check_length("radius", def->radius, error) : TY_OK;
    return status == TY_OK ? check_extents(def, error) : status;
}

// The ball is stretched afterwards: a linear map carries normals and curvatures exactly.
static void stretch_ball(const ty_shape_def* def, ty_mesh* mesh)
{
    ty_vec3 s = def->kind == TY_SHAPE_SPHERE ? ty_vec3_make(def->radius, def->radius, def->radius) : def->size;
    ty_affine m = {{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}, {0, 0, 0}};
    ty_mesh_transform(mesh, &m);
}

static void build_kind(ty_shape_build* build, const ty_shape_def* def)
{
    switch ((ty_shape_kind)def->kind)
    {
    case TY_SHAPE_SPHERE:
    case TY_SHAPE_ELLIPSOID:
    case TY_SHAPE_STONE:
    case TY_SHAPE_BLOCK:
        ty_shape_build_ball(build, def->divisions);
        break;
    case TY_SHAPE_BOX:
        ty_shape_build_box(build, def);
        break;
    case TY_SHAPE_CYLINDER:
        ty_shape_build_cylinder(build, def);
        break;
    case TY_SHAPE_TORUS:
        ty_shape_build_torus(build, def);
        break;
    case TY_SHAPE_PLANE:
        ty_shape_build_plane(build, def);
        break;
    case TY_SHAPE_DISC:
        ty_shape_build_disc(build, def);
        break;
    case TY_SHAPE_BOWL:
        ty_shape_build_bowl(build, def);
        break;
    case TY_SHAPE_DOME:
        ty_shape_build_dome(build, def);
        break;
    case TY_SHAPE_SWEEP:
        ty_shape_build_sweep(build, def);
        break;
    case TY_SHAPE_LATHE:
        ty_shape_build_lathe(build, def);
        break;
    case TY_SHAPE_TUBE:
        ty_shape_build_tube(build, def);
        break;
    }
}

ty_status ty_shape_create(const ty_shape_def* given, ty_mesh** out, ty_error* error)
{
    const ty_shape_def complete = ty_shape_def_complete(given), *def = &complete;
    *out = NULL;
    ty_status status = check_def(def, error);
    if (status != TY_OK)
        return status;
    ty_shape_build build = {0};
    build_kind(&build, def);
    status = ty_shape_finish(&build, out, error);
    if (status == TY_OK && (def->kind == TY_SHAPE_SPHERE || def->kind == TY_SHAPE_ELLIPSOID))
        stretch_ball(def, *out);
    if (status == TY_OK && def->kind == TY_SHAPE_STONE)
        ty_shape_bend_stone(def, *out);
    if (status == TY_OK && def->kind == TY_SHAPE_BLOCK)
        ty_shape_bend_block(def, *out);
    return status;
}
