// SPDX-License-Identifier: Apache-2.0
// Cameras: rays through a lens of some shape and projection, also while they move, and the matrices that a picture
// carries.
#pragma once
#include <tsuya/scene/scene.h>

#define TY_LENS_SEGMENTS 16 // straight pieces of an edge between two corners of the aperture

// The shape of the aperture, within the unit disc.
typedef struct ty_lens
{
    int blades;        // below 3 = round
    float rotation[2]; // cosine and sine
    float inverse_squeeze;
    ty_vec2 edge[TY_LENS_SEGMENTS + 1]; // from one corner to the next
    float share[TY_LENS_SEGMENTS + 1];  // of the sector's area before each piece
} ty_lens;

void ty_lens_init(ty_lens* lens, const ty_camera_def* def);
// Uniform over the aperture's area; u in [0,1).
ty_vec2 ty_lens_sample(const ty_lens* lens, ty_vec2 u);

typedef struct ty_camera
{
    ty_projection projection;
    ty_vec3 origin;
    ty_vec3 right, up, forward;    // unit; forward is where it looks, its own -z
    float half_width, half_height; // of the image plane at distance 1; orthographic: m
    float shift[2];                // in half widths and half heights
    float inverse_size[2];         // 1 / pixels
    float lens_radius;             // m, 0 = pinhole
    float focus_distance;          // m, along forward
    float near_clip, far_clip;     // m, along forward (equirectangular: along the ray); TY_FLOAT_MAX = none
    ty_lens lens;
} ty_camera;

void ty_camera_init(ty_camera* camera, const ty_camera_def* def, const int size[2]);

// The camera at a time within the shutter, between count poses at even steps (the aperture's shape is that of the
// first).
void ty_camera_at(const ty_camera* steps, int count, float time, ty_camera* out);

// Through the point (x, y) of the picture in pixels (y down, centres at .5); lens: two numbers in [0,1).
ty_ray ty_camera_ray(const ty_camera* camera, float x, float y, ty_vec2 lens);

// Distance of a point along the camera's axis; equirectangular: from the camera.
float ty_camera_depth(const ty_camera* camera, ty_vec3 p);

// As OpenEXR's standard attributes define them, for row vectors: camera space is left-handed and looks along +z; NDC is
// (0, 0) in the upper left and (1, 1) in the lower right corner of the picture, after division by w. An equirectangular
// picture has no such matrix: false.
void ty_camera_world_to_camera(const ty_camera* camera, float m[16]);
bool ty_camera_world_to_ndc(const ty_camera* camera, float m[16]);
