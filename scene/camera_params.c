// SPDX-License-Identifier: Apache-2.0
// Table and defaults of the camera.
#include <tsuya/scene/scene.h>

#define MANY 1e30 // a bound that bounds nothing but infinity

ty_camera_def ty_camera_def_default(void)
{
    return (ty_camera_def){.position = {0.0f, 0.0f, 1.0f},
                           .up = {0.0f, 1.0f, 0.0f},
                           .vfov = ty_radians(40.0f),
                           .ortho_height = 1.0f,
                           .film_height = 0.024f,
                           .squeeze = 1.0f,
                           .near_clip = 0.001f,
                           .motion_steps = 5};
}

static void set_default(void* def)
{
    *(ty_camera_def*)def = ty_camera_def_default();
}

static const char* const projections[] = {"perspective", "orthographic", "equirectangular", NULL};
static const char* const positions[] = {"center", "start", "end", NULL};

#define FIELD(name) offsetof(ty_camera_def, name)
static const ty_param rows[] = {
    {"projection", TY_PARAM_ENUM, "", 0, 0, projections, NULL, FIELD(projection),
     "perspective, orthographic, or equirectangular: all directions, longitude across and latitude down", false},
    {"position", TY_PARAM_FLOAT3, "m", -1e9, 1e9, NULL, NULL, FIELD(position), "where the eye is", false},
    {"look_at", TY_PARAM_FLOAT3, "m", -1e9, 1e9, NULL, NULL, FIELD(look_at), "the point in the middle of the picture",
     false},
    {"up", TY_PARAM_FLOAT3, "", -1e9, 1e9, NULL, NULL, FIELD(up), "direction that is up in the picture", false},
    {"vfov", TY_PARAM_FLOAT, "deg", 0.01, 179, NULL, NULL, FIELD(vfov), "vertical field of view", false},
    {"focal_length", TY_PARAM_FLOAT, "mm", 0, 100000, NULL, NULL, FIELD(focal_length),
     "instead of vfov: gives it with the film's height; 0 = vfov does", false},
    {"film_height", TY_PARAM_FLOAT, "mm", 0.01, 10000, NULL, NULL, FIELD(film_height),
     "height of the film, gives the focal length and with f_stop the aperture", false},
    {"film_width", TY_PARAM_FLOAT, "mm", 0, 10000, NULL, NULL, FIELD(film_width),
     "instead of film_height: the height then follows from the picture's shape; 0 = film_height does", false},
    {"shift", TY_PARAM_FLOAT2, "", -10, 10, NULL, NULL, FIELD(shift),
     "lens shift in widths and heights of the picture: to the right and up", false},
    {"ortho_height", TY_PARAM_FLOAT, "m", 1e-9, 1e9, NULL, NULL, FIELD(ortho_height),
     "orthographic: what the picture's height shows", false},
    {"f_stop", TY_PARAM_FLOAT, "", 0, MANY, NULL, NULL, FIELD(f_stop), "aperture number; 0 = everything is sharp",
     false},
    {"aperture", TY_PARAM_FLOAT, "mm", 0, 1e6, NULL, NULL, FIELD(aperture),
     "diameter of the lens, instead of f_stop; orthographic knows this alone", false},
    {"focus_distance", TY_PARAM_FLOAT, "m", 0, MANY, NULL, NULL, FIELD(focus_distance),
     "distance of the sharp plane; 0 = that of focus_object, focus_point or look_at", false},
    {"focus_point", TY_PARAM_FLOAT3, "m", -1e9, 1e9, NULL, NULL, FIELD(focus_point),
     "a point on the sharp plane; look_at if not given", false},
    {"focus_object", TY_PARAM_STRING, "", 0, 0, NULL, NULL, FIELD(focus_object),
     "name of an object: the sharp plane goes through the middle of its box, also while it moves", false},
    {"blades", TY_PARAM_INT, "", 0, 64, NULL, NULL, FIELD(blades), "of the aperture; below 3 it is round", false},
    {"blade_rotation", TY_PARAM_FLOAT, "deg", -3600, 3600, NULL, NULL, FIELD(blade_rotation),
     "counter-clockwise in the picture; 0 = a corner to the right", false},
    {"blade_curvature", TY_PARAM_FLOAT, "", 0, 1, NULL, NULL, FIELD(blade_curvature), "0 = straight edges, 1 = round",
     false},
    {"squeeze", TY_PARAM_FLOAT, "", 0.1, 10, NULL, NULL, FIELD(squeeze),
     "of an anamorphic lens: blurs are this much higher than wide", false},
    {"near_clip", TY_PARAM_FLOAT, "m", 0, 1e6, NULL, NULL, FIELD(near_clip), "nothing nearer than this is seen", false},
    {"far_clip", TY_PARAM_FLOAT, "m", 0, MANY, NULL, NULL, FIELD(far_clip),
     "no surface farther than this is seen; 0 = no limit", false},
    {"shutter", TY_PARAM_FLOAT, "", 0, 100, NULL, NULL, FIELD(shutter),
     "frames that the shutter is open (0.5 = 180 degrees); 0 = no motion blur", false},
    {"shutter_position", TY_PARAM_ENUM, "", 0, 0, positions, NULL, FIELD(shutter_position),
     "where the frame's moment is: in the middle of the open shutter, at its start or at its end", false},
    {"motion_steps", TY_PARAM_INT, "", 2, 33, NULL, NULL, FIELD(motion_steps),
     "poses over the open shutter: more for strongly curved motion", false},
};

static const ty_param_table table = {"camera",
                                     "What is seen, through which lens, and for how long.",
                                     sizeof(ty_camera_def),
                                     set_default,
                                     rows,
                                     TY_PARAM_COUNT(rows)};

const ty_param_table* ty_camera_params(void)
{
    return &table;
}
