// SPDX-License-Identifier: Apache-2.0
// The perspective camera: rays through a thin lens, and the matrices that a picture carries.
#pragma once
#include <tsuya/scene/scene.h>

typedef struct ty_camera
{
    ty_vec3 origin;
    ty_vec3 right, up, forward;    // unit; forward is where it looks, its own -z
    float half_width, half_height; // of the image plane at distance 1
    float inverse_size[2];         // 1 / pixels
    float lens_radius;             // m, 0 = pinhole
    float focus_distance;          // m, along forward
    float near_clip;               // m, along forward
} ty_camera;

void ty_camera_init(ty_camera* camera, const ty_camera_def* def, const int size[2]);

// Through the point (x, y) of the picture in pixels (y down, centres at .5); lens: two numbers in [0,1).
ty_ray ty_camera_ray(const ty_camera* camera, float x, float y, ty_vec2 lens);

// Distance of a point along the camera's axis.
float ty_camera_depth(const ty_camera* camera, ty_vec3 p);

// As OpenEXR's standard attributes define them, for row vectors: camera space is left-handed and looks along +z; NDC is
// (0, 0) in the upper left and (1, 1) in the lower right corner of the picture, after division by w.
void ty_camera_world_to_camera(const ty_camera* camera, float m[16]);
void ty_camera_world_to_ndc(const ty_camera* camera, float m[16]);
