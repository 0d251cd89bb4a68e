// SPDX-License-Identifier: Apache-2.0
// What exists: a scene read from YAML, frozen between one frame and the next.
#pragma once
#include <tsuya/base/arena.h>
#include <tsuya/base/params.h>
#include <tsuya/base/workers.h>
#include <tsuya/geometry/trace.h>
#include <tsuya/image/color.h>
#include <tsuya/image/mip_texture.h>
#include <tsuya/image/texture.h>
#include <tsuya/shading/environment_table.h>
#include <tsuya/shading/material.h>

typedef enum ty_filter_kind
{
    TY_FILTER_BOX,
    TY_FILTER_GAUSSIAN,
    TY_FILTER_BLACKMAN_HARRIS,
} ty_filter_kind;

typedef struct ty_film_def
{
    int size[2];        // pixels
    int filter;         // ty_filter_kind
    float filter_width; // pixels, full width
    bool half;          // beauty channels as half (else float)
} ty_film_def;

typedef enum ty_projection
{
    TY_PROJECTION_PERSPECTIVE,
    TY_PROJECTION_ORTHOGRAPHIC,
    TY_PROJECTION_EQUIRECTANGULAR, // all directions: longitude across, latitude down; the middle is where it looks
} ty_projection;

// Which moment of the open shutter is the frame's own.
typedef enum ty_shutter_position
{
    TY_SHUTTER_CENTER,
    TY_SHUTTER_START,
    TY_SHUTTER_END,
} ty_shutter_position;

typedef struct ty_camera_def
{
    int projection;                // ty_projection
    ty_vec3 position, look_at, up; // m
    float vfov;                    // radians; perspective
    float ortho_height;            // m; orthographic: what the picture's height shows
    float shift[2];                // of the film, in its widths and heights, to the right and up
    float f_stop;                  // 0 = pinhole; aperture diameter = focal length / f_stop
    float aperture;                // m, diameter, instead of f_stop
    float film_height;             // m, gives the focal length: height / (2 tan(vfov / 2))
    float film_width;              // m; as read: film_height is what it makes of it
    float focal_length;            // m; as read: vfov is what it makes of it
    float focus_distance;          // m; 0 = the distance to focus_point or look_at
    ty_vec3 focus_point;           // used when has_focus_point
    bool has_focus_point;
    const char* focus_object; // name or NULL; focus_point is then the middle of its box
    int blades;               // of the aperture; below 3 = round
    float blade_rotation;     // radians, counter-clockwise in the picture
    float blade_curvature;    // 0 = straight edges .. 1 = round
    float squeeze;            // of an anamorphic lens: blurs are this much higher than wide; 0 = 1
    float near_clip;          // m
    float far_clip;           // m; 0 = none
    float shutter;            // frames that it is open; 0 = nothing moves
    int shutter_position;     // ty_shutter_position
    int motion_steps;         // poses over the shutter, 2..33
} ty_camera_def;

typedef enum ty_integrator_kind
{
    TY_INTEGRATOR_PATH,
    TY_INTEGRATOR_ALBEDO,
    TY_INTEGRATOR_NORMAL,
    TY_INTEGRATOR_CURVATURE,
    TY_INTEGRATOR_AO,
} ty_integrator_kind;

typedef enum ty_light_sampling
{
    TY_LIGHT_SAMPLING_MIS,   // of lights and of surfaces, weighted
    TY_LIGHT_SAMPLING_LIGHT, // of lights alone where it can be
    TY_LIGHT_SAMPLING_BSDF,  // of surfaces alone where it can be
} ty_light_sampling;

typedef enum ty_light_choice
{
    TY_LIGHT_CHOICE_PLACE, // by where they are, too, when there are many
    TY_LIGHT_CHOICE_POWER,
} ty_light_choice;

typedef struct ty_render_def
{
    int integrator;           // ty_integrator_kind
    int samples;              // per pixel
    int max_depth;            // surface interactions of a path
    int roulette_depth;       // no Russian roulette before this many interactions
    bool indirect_subsurface; // light walks within bodies that other light falls on, too
    float indirect_clamp;     // largest channel of what one path adds after its second scattering; 0 = unlimited
    ty_seed seed;             // of this frame, with animate_seed
    bool animate_seed;        // other noise in every frame
    int light_sampling;       // ty_light_sampling
    int light_choice;         // ty_light_choice
    bool texture_filter;      // textures are averaged over what a ray stands for
    float ao_distance;        // m
    float curvature_scale;    // m: curvature * scale is shown as grey around .5
} ty_render_def;

// Frames are numbers; those between whole ones exist. Frame `start` is second 0.
typedef struct ty_timeline_def
{
    float fps;
    int start, end; // the frames that `--frames all` means
} ty_timeline_def;

typedef enum ty_turntable_kind
{
    TY_TURN_CAMERA,  // the camera goes round what stands still
    TY_TURN_OBJECTS, // all objects turn; camera and lights stay
} ty_turntable_kind;

typedef struct ty_turntable_def
{
    int turn;      // ty_turntable_kind
    float angle;   // radians about axis, counter-clockwise seen against it
    ty_vec3 axis;  // not zero
    ty_vec3 about; // m, a point on the axis, used when has_about; else the camera's look_at
    bool has_about;
} ty_turntable_def;

#define TY_LIGHT_GROUPS 16     // most light groups of a scene
#define TY_LIGHT_GROUP_NAME 40 // most bytes of a group's name

typedef enum ty_light_kind
{
    TY_LIGHT_ENVIRONMENT, // constant radiance, or image (latitude-longitude, y up)
    TY_LIGHT_SKY,         // a gradient from the ground over the horizon to the zenith, and a sun
    TY_LIGHT_RECTANGLE,
    TY_LIGHT_DISK,
    TY_LIGHT_SPHERE,
    TY_LIGHT_CYLINDER, // its round side, from outside
    TY_LIGHT_POINT,
    TY_LIGHT_SPOT,
    TY_LIGHT_DIRECTIONAL,
} ty_light_kind;

// Rays that see a light or an object by what they left: the camera, or the lobe that was sampled.
typedef struct ty_visible_def
{
    bool camera, diffuse, glossy, transmission;
    bool shadow; // objects: whether they stop light
} ty_visible_def;

typedef struct ty_light_def
{
    const char* name;        // NULL = none
    int kind;                // ty_light_kind
    const char* group;       // light group, NULL = "default"
    int group_index;         // into the scene's light_groups
    ty_rgb radiance;         // W/(m^2 sr): environment, rectangle, disk, sphere, cylinder
    ty_rgb intensity;        // W/sr: point; spot: along its axis
    ty_rgb irradiance;       // W/m^2 on a plane facing it: directional
    float power;             // W, all that leaves it, in place of radiance or intensity where it is given
    ty_rgb color;            // factor
    float exposure;          // factor 2^exposure
    ty_vec3 center, target;  // m; a rectangle, disk or spot faces its target; directional: from center towards target
    ty_vec3 up;              // orientation of a rectangle or of a spot's image
    float size[2];           // m, full width and height
    float radius;            // m
    ty_vec3 axis;            // cylinder
    float length;            // m, cylinder
    float cone, penumbra;    // spot: full angle in radians; share of the half angle over which it fades
    float angle;             // directional: full angle in radians, 0 = sharp shadows
    ty_rgb zenith;           // W/(m^2 sr): sky
    ty_rgb horizon, ground;  // the same
    float falloff;           // exponent of the gradient over the sine of the height
    ty_rgb sun_irradiance;   // W/m^2 on a plane facing it
    float sun_elevation;     // radians above the horizon
    float sun_azimuth;       // radians from -z over +x
    float sun_angle;         // radians, full
    const char* image;       // path: environment, spot
    const char* color_space; // of the image, NULL = guess
    float rotate;            // radians about +y: environment, sky
    ty_vec3 orientation;     // radians about x, then y, then z, before rotate: environment
    bool camera_visible;     // the older way to write visible.camera
    ty_visible_def visible;
    bool shadows; // what stands in its way hides it
} ty_light_def;

ty_film_def ty_film_def_default(void);
ty_camera_def ty_camera_def_default(void);
ty_render_def ty_render_def_default(void);
ty_light_def ty_light_def_default(void);
ty_timeline_def ty_timeline_def_default(void);
ty_turntable_def ty_turntable_def_default(void);
const ty_param_table* ty_film_params(void);
const ty_param_table* ty_camera_params(void);
const ty_param_table* ty_render_params(void);
const ty_param_table* ty_light_params(void);
const ty_param_table* ty_timeline_params(void);
const ty_param_table* ty_turntable_params(void);

typedef struct ty_scene_object
{
    const char* name;               // as in the file, or "object3"
    uint32_t material;              // index; with slots: what is left without one of its own
    const uint32_t* slot_materials; // [slot_count] by the mesh's material slots, or NULL: `material` everywhere
    uint32_t slot_count;
    const float* const* attributes; // [attribute_count] -> [instances] or NULL
    const uint32_t* ids;            // [instances] from the aggregate file, or NULL
    uint32_t instance_count;
    uint32_t mask;   // ty_mask: the rays that may meet it
    int light_group; // of what its material emits: index into the scene's light_groups
    int light_link;  // which lights light it: index into the scene's light_links
} ty_scene_object;

// How often something was made or read again for another frame, since the scene was loaded.
typedef struct ty_scene_rebuilds
{
    int frames; // ty_scene_set_frame
    int cameras, materials, lights, objects;
    int meshes; // with their trees
    int worlds; // top-level trees; those of prototypes that do not change stay
} ty_scene_rebuilds;

// Frozen: const for the renderer. Owned by its arena and ty_scene_destroy.
typedef struct ty_scene
{
    ty_arena* arena;
    const char* path; // of the scene file
    ty_film_def film;
    ty_camera_def camera;        // of this frame, turned by the turntable
    ty_camera_def* camera_steps; // at even steps over the open shutter
    int camera_step_count;       // 1 = at rest
    bool moves;                  // camera, objects or instances, while the shutter is open: rays have a time
    ty_render_def render;
    ty_timeline_def timeline;
    ty_turntable_def turntable;
    double frame, seconds; // of this frame; seconds since timeline.start
    ty_scene_rebuilds rebuilds;
    ty_color* color;
    ty_world* world;
    ty_scene_object* objects; // by world object index
    int object_count;
    ty_material** materials;
    const char** material_names;
    int material_count;
    ty_light_def* lights;
    ty_texture** light_images; // [light_count], NULL where none
    int light_count;
    const char** light_groups; // [light_group_count]; the first is "default"
    int light_group_count;     // at most TY_LIGHT_GROUPS
    const bool** light_links;  // [light_link_count] -> [light_count + object_count], lights before emitting objects
    int light_link_count;      // the first is NULL: all of them
    const ty_environment_table** light_tables; // [light_count], NULL where no environment shows an image
    ty_environment_table* environment_tables;  // [texture_count], empty where no environment shows the image
    ty_texture** textures;                     // that light_images point to
    int texture_count;
    ty_mip_cache* texture_cache;       // NULL when no material has textures
    ty_mip_texture** surface_textures; // of materials, at this frame
    int surface_texture_count;
    const char** attribute_names;
    int attribute_count;
    ty_depth_field** depth_fields; // by prototype
    ty_shading_context shading;    // ready for use
    const char* recipe; // complete text of the scene at this frame: variables, overrides, includes and recipes resolved
    const char* overrides;                // "-D a=b --set c=d", as given; "" if none
    char hash[33];                        // of the recipe and of every file that went in
    struct ty_scene_resources* resources; // private: meshes and aggregates
    // statistics of loading, seconds and counts
    double load_seconds, asset_seconds, build_seconds;
    int assets_made, assets_cached;
    uint64_t triangle_count, instance_count; // unique triangles; instances
} ty_scene;

typedef struct ty_scene_options
{
    const char* const* sets; // "path=value"
    int set_count;
    const char* const* variables; // "name=value"
    int variable_count;
    const char* ocio;         // --ocio or NULL
    const char* isa;          // --isa or NULL
    const char* cache_folder; // NULL = $TSUYA_CACHE, else $XDG_CACHE_HOME/tsuya, else ~/.cache/tsuya; "none": none
    uint64_t texture_bytes;   // of textures in memory at a time; 0 = TY_MIP_CACHE_BYTES. Changes no picture.
    bool sandbox;             // no path outside the scene's folder
    bool quick;               // half size and 16 samples, as overrides before all others
    const double* frame;      // to begin with; NULL = as the file says
    const int* frames;        // [frame_count] that will be asked for, ascending: a sequence or key that does not
    int frame_count;          // cover them is a mistake. 0 = not known
    bool check_only;          // read and verify everything, but make no asset and build no tree
    ty_trace_path trace_path;
    ty_workers* workers; // for generators; NULL = the caller
    // Of ty_recipe_make; NULL = not.
    const char* resume;  // an aggregate, or the state of a run of frames, that is gone on from
    const char* state;   // where a run of frames keeps its state, at its end or when it is interrupted
    const char* picture; // a pattern for frames as pictures (.png) too
    const char* volume;  // a file for frames as the slices of a volume too, .raw or .nrrd
    char** report;       // takes the figures of a loop or of roots, a JSON object; freed by the caller
    const char* curves;  // where the centre lines of roots go, .ply
    const char* host;    // where a mesh of what roots hold on to goes, .ply, .obj or .glb
} ty_scene_options;

// path: a scene file, a folder with scene.yaml, or a glTF file, which gets light and a camera where it has none. On
// failure *out is NULL and errors holds every mistake found.
TY_CHECKED ty_status ty_scene_load(const char* path, const ty_scene_options* options, ty_scene** out,
                                   ty_error_list* errors);
// The same from memory, e.g. the recipe of a picture. name stands in messages; files are found from its folder.
TY_CHECKED ty_status ty_scene_load_memory(const char* name, const void* bytes, size_t size,
                                          const ty_scene_options* options, ty_scene** out, ty_error_list* errors);
void ty_scene_destroy(ty_scene* scene); // NULL is allowed

// What a scene's section `timeline` says, overrides included, without loading the scene: for commands that key values
// by its frames. Mistakes are left to the loading, which tells all of them; what they hide is as by default.
ty_timeline_def ty_scene_read_timeline(const char* path, const ty_scene_options* options);

// The scene as it is at another frame: keyed values are read again and what depends on them is rebuilt; assets never
// are. Recipe and hash become those of the frame. Not while somebody renders it. On failure the scene can be given
// another frame or destroyed, nothing else.
TY_CHECKED ty_status ty_scene_set_frame(ty_scene* scene, double frame, ty_error_list* errors);

// The material of a triangle of an object's instance.
static inline const ty_material* ty_scene_material(const ty_scene* scene, uint32_t object, uint32_t instance,
                                                   uint32_t triangle)
{
    const ty_scene_object* o = &scene->objects[object];
    if (!o->slot_materials)
        return scene->materials[o->material];
    const uint16_t* slots = ty_world_mesh(scene->world, object, instance)->slots;
    return scene->materials[o->slot_materials[slots ? slots[triangle] : 0]];
}

// The materials that an object may show: index k of count.
static inline uint32_t ty_scene_material_count(const ty_scene_object* object)
{
    return object->slot_materials ? object->slot_count : 1;
}
static inline uint32_t ty_scene_material_at(const ty_scene_object* object, uint32_t k)
{
    return object->slot_materials ? object->slot_materials[k] : object->material;
}

// Makes the asset of a recipe file and writes it to output, whether or not it is in the cache: an aggregate to a .glb,
// a mesh to a .ply, .obj or .glb (with #### its growth), frames to a pattern with ####. kind (NULL = any) is what the
// recipe has to be. element: above 0 = of an aggregate's elements this one alone, as a .ply.
TY_CHECKED ty_status ty_recipe_make(const char* recipe, const char* kind, const char* output, int element,
                                    const ty_scene_options* options, ty_error_list* errors);

// The folder of made assets: given (may be NULL), else $TSUYA_CACHE, else $XDG_CACHE_HOME/tsuya, else ~/.cache/tsuya.
// Created when missing; out has TY_PATH_MAX bytes. "none" for the first or second: nothing is kept, and out is empty.
TY_CHECKED ty_status ty_scene_cache_folder(const char* given, char* out, ty_error* error);

// Every table there is, for `tsuya params`, the schema and the reference.
const ty_param_table* const* ty_scene_tables(int* count);
// Text for `tsuya params [PATH]`, JSON Schema, and the Markdown reference; caller frees with ty_free.
// NULL when path names nothing (suggestion then holds the nearest name).
char* ty_params_text(const char* path, char suggestion[64]);
char* ty_params_schema(void);
char* ty_params_markdown(void);
