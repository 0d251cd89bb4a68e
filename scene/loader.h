// SPDX-License-Identifier: Apache-2.0
// The state of loading one scene or recipe. A scene keeps it, because its tree is evaluated again for every frame.
#pragma once
#include "document.h"
#include "params_read.h"
#include "scene_params.h"
#include "text.h"
#include "timeline.h"
#include <tsuya/generate/asset.h>
#include <tsuya/geometry/gltf.h>
#include <tsuya/geometry/shape.h>
#include <tsuya/scene/scene.h>

// What `kind: ...` mappings become.
typedef struct ty_recipe
{
    const ty_generator* generator;
    void* def;
    ty_node* node;              // as read: its canonical text is the recipe
    int files_begin, files_end; // entries that it names
} ty_recipe;

typedef enum ty_asset_kind
{
    TY_ASSET_NONE, // wrong in the file, reported
    TY_ASSET_MESH,
    TY_ASSET_SHAPE,
    TY_ASSET_TEXTURE,
    TY_ASSET_FRAMES,    // files
    TY_ASSET_AGGREGATE, // a file
    TY_ASSET_RECIPE,
    TY_ASSET_GLTF,
} ty_asset_kind;

typedef struct ty_asset
{
    const char* name;
    ty_asset_kind kind;
    ty_place place; // of the name of the file, or of the value
    const char* path;
    ty_shape_def shape;
    ty_recipe recipe;
    int prototype;        // AGGREGATE: asset index or -1
    float velocity_scale; // AGGREGATE
    ty_texture_asset_def texture_def;
    ty_frames_asset_def frames_def; // FRAMES, and recipes of frames
    bool used;
    bool is_texture; // some material uses it as one
    bool bounds_known;
    ty_bounds bounds;                                 // of everything, in the asset's own space
    ty_mesh* mesh;                                    // once loaded
    ty_aggregate* aggregate;                          // once loaded
    const char* frames;                               // RECIPE of frames: the pattern, once made
    struct ty_mesh_sequence* sequence;                // MESH of a pattern
    struct ty_aggregate_sequence* aggregate_sequence; // AGGREGATE of a pattern
    ty_gltf_scene* gltf; // GLTF, and MESH of such a file: opened ahead of reading the tables; owned by the scene
    int first_material;  // GLTF: of its materials among the scene's; the one for triangles without comes last
} ty_asset;

typedef struct ty_attribute_use
{
    int material, attribute;
    ty_place place;
} ty_attribute_use;

typedef struct ty_object_entry
{
    ty_object_def def;
    ty_place place;
    int asset, material;  // -1 = wrong, reported
    const ty_node* slots; // `materials`, NULL = none
    ty_affine transform;
    int first, count;               // what it places
    int keys;                       // index in the timeline's entries, -1 = none
    ty_affine *steps, *built_steps; // over the shutter: now, and as the world has them; NULL where nothing moves
    int step_count, step_capacity;  // of built_steps, 0 = not known; of both
} ty_object_entry;

// An object of the world, by its number there: all of an entry of `objects`, or one of a glTF scene's.
typedef struct ty_placed_object
{
    int entry;
    const ty_gltf_object* part; // NULL = the asset itself
    const char* name;           // of what it shows, for messages
    ty_mesh* mesh;              // either of them once loaded
    ty_aggregate* aggregate;
    ty_object_flags flags;
    bool flags_known;    // found when the world was built first
    uint32_t built_mask; // as the world has it
} ty_placed_object;

// A texture of materials.
typedef struct ty_surface_texture
{
    ty_mip_texture_def def; // path NULL until a recipe has made the frames
    ty_place place;
    int asset; // of a sequence; -1 = a single image
} ty_surface_texture;

// An image of lights.
typedef struct ty_texture_entry
{
    ty_texture_def def;
    ty_place place;
} ty_texture_entry;

#define TY_SCENE_PASSING "/tmp/tsuya-XXXXXX" // a folder for what is not kept

// What a scene owns besides its public arrays.
struct ty_scene_resources
{
    ty_mesh** meshes;
    ty_aggregate** aggregates;
    ty_gltf_scene** gltfs;
    struct ty_mesh_sequence** sequences;
    int sequence_count;
    int mesh_count, aggregate_count, gltf_count;
    const char** passing; // folders of frames and images that are not kept, removed at the end
    int passing_count;
    const char* images; // the one of images, NULL = none
    uint32_t depth_field_count;
    char* recipe;             // what ty_scene.recipe points to, owned
    struct ty_loader* loader; // owned; NULL until the scene is complete
};

typedef struct ty_loader
{
    const ty_scene_options* options;
    ty_scene_options kept_options; // without what only the first load asks for
    ty_error_list* errors;
    ty_arena* arena; // of the scene
    ty_tree tree;    // in an arena of its own
    ty_files files;
    ty_reader reader;
    ty_node* root;
    ty_variables* variables;
    ty_variables* defines; // -D names that the scene itself does not know: recipes may
    ty_scene* scene;
    ty_node *asset_map, *material_map; // NULL = none
    ty_asset* assets;
    int asset_count;
    ty_texture_entry* textures; // [texture_capacity], count in the scene
    int texture_capacity;
    ty_surface_texture* surface_textures; // [surface_texture_capacity], count in the scene
    int surface_texture_capacity;
    ty_attribute_use* uses;
    int use_count, use_capacity;
    int current_material;     // while its table is read
    bool* textured;           // [material_count]
    ty_object_entry* objects; // [entry_count] of the list
    int entry_count;
    ty_placed_object* placed; // [object_count] of the scene
    ty_node** gltf_materials; // [material_count - those of the section]
    int* light_textures;      // [light_count], -1 = none
    bool is_recipe;           // the root is a recipe, not a scene
    ty_timeline timeline;
    ty_node* frame_node; // `frame:` of the file; NULL = the recipe does not tell it
    ty_seed seed;        // as written in `render`
    bool checks_keys;    // tables are read for their mistakes alone: a material may take 30 ms to make
    bool world_changed;  // objects stand elsewhere than in the world
    bool poses_move;     // camera or objects do, while the shutter is open
    bool instances_move; // those of aggregates do by their own velocities, as the world has them
    bool meshes_move;    // vertices of sequences do
    float shutter[2];    // s, when it opens and closes, from the frame's moment
    int focus_object;    // of the camera, -1 = none
    int camera_capacity; // of the scene's camera_steps
} ty_loader;

// loader.c
// With an empty scene, which the caller destroys or keeps.
ty_loader* ty_loader_create(const char* folder, const ty_scene_options* options, ty_error_list* errors);
void ty_loader_destroy(ty_loader* loader); // not the scene
void ty_loader_keep(ty_loader* loader);    // with its scene, for other frames
void ty_loader_report_to(ty_loader* loader, ty_error_list* errors);
// The tree in loader->root made final: version, overrides, variables, recipe files in place. False when reading the
// tables makes no sense any more.
bool ty_loader_resolve(ty_loader* loader);
bool ty_loader_resolve_tree(ty_loader* loader); // overrides and variables alone: what `timeline` says
ty_status ty_loader_status(const ty_error_list* errors, int first); // of the errors from first on
// Room for one more item; the old array stays in the arena.
void* ty_loader_grow(ty_arena* arena, void* items, int count, int* capacity, size_t size);
ty_node* ty_section(ty_loader* loader, const char* name,
                    ty_node_kind kind); // NULL if absent, empty or wrong (reported)

// override.c: `path=value` on the tree; early: those of vars and search, which others depend on, else the rest.
void ty_override_sets(ty_loader* loader, bool early);
void ty_override_quick(ty_loader* loader);     // half the film's size, 16 samples; before the sets, which win
void ty_override_variables(ty_loader* loader); // -D
void ty_override_check_defines(ty_loader* loader);
const char* ty_override_text(ty_arena* arena, const ty_scene_options* options); // as given, in one line

// recipe.c
// Of what is made as frames, pictures or meshes that grow; 0 = it is one file.
int ty_recipe_frames(const ty_recipe* recipe);
bool ty_recipe_is_file(const ty_node* node); // a scalar that names .yaml, .yml or .json
// The file's mapping in place of its name; what: "recipe" or "calibration", for messages.
void ty_recipe_inline(ty_loader* loader, ty_node** slot, const char* what);
bool ty_recipe_is_place(const char* key); // aggregate, mesh, frames, fill, loop, filter
bool ty_recipe_belongs(const ty_generator* generator, const char* place);
// place: the key it stands at, to be one that such an asset belongs to, or NULL. False after a report.
bool ty_recipe_read(ty_loader* loader, ty_node* node, const char* place, ty_recipe* recipe);
// The frames that it makes will have that channel; false after a report.
bool ty_recipe_bring_channel(ty_loader* loader, ty_recipe* recipe, const ty_node* channel);
char* ty_recipe_text(const ty_recipe* recipe); // a complete recipe file; caller frees
// Runs the generator and writes what it makes, with its recipe and hash: a .glb, a .ply, or frames by a pattern. cache:
// a folder for what another run can use, or NULL. TY_NOT_AT_REST when what was asked for is complete but not at rest.
TY_CHECKED ty_status ty_recipe_write(const ty_recipe* recipe, const char* key, const char* output, const char* cache,
                                     ty_workers* workers, ty_error* error);
TY_CHECKED ty_status ty_recipe_key(const ty_recipe* recipe, ty_files* files, char key[33], ty_error* error);

// frame_write.c: a frame of a generator, Y or R, G, B in ACEScg, by the ending: .exr, or .png as sRGB shows it.
TY_CHECKED ty_status ty_frame_write(const char* path, const ty_exr* frame, const ty_color* color, ty_error* error);

// frame_volume.c: frames into one file, a slice each. Zeroed but for path, .raw or .nrrd, and depth, the frames there
// will be.
typedef struct ty_frame_volume
{
    const char* path;
    int depth, width, height;
    bool begun;
    ty_atomic_file file;
    int fd;
    size_t head; // bytes before the first number
} ty_frame_volume;

TY_CHECKED ty_status ty_frame_volume_put(ty_frame_volume* volume, int frame, const ty_exr* image, ty_error* error);
// The file is there when it is complete, else nothing is.
TY_CHECKED ty_status ty_frame_volume_end(ty_frame_volume* volume, bool complete, ty_error* error);

// asset_cache.c: what a recipe makes, made at most once per cache folder, into the asset's aggregate, mesh or frames.
TY_CHECKED ty_status ty_asset_cache_get(ty_loader* loader, ty_asset* asset, ty_error* error);

// scene_assets.c, scene_materials.c, scene_lights.c, scene_objects.c: sections of the file to definitions
void ty_read_assets(ty_loader* loader);
int ty_asset_find(ty_loader* loader, const ty_node* name); // index; -1 after a report
void ty_read_materials(ty_loader* loader);
int ty_material_find(const ty_loader* loader, const char* name); // -1 = none
void ty_read_view(ty_loader* loader);                            // film, camera, render, turntable
void ty_read_lights(ty_loader* loader);
void ty_read_objects(ty_loader* loader);
// One of them again, for the values that its keys have now.
void ty_read_material(ty_loader* loader, int index);
void ty_read_camera(ty_loader* loader);
void ty_focus_camera(ty_loader* loader); // on its object, where that stands now
void ty_read_turntable(ty_loader* loader);
void ty_pose_object(ty_loader* loader, int index);            // its transform alone
bool ty_turntable_map(const ty_scene* scene, ty_affine* map); // the turn at this moment; false = none
void ty_read_section(ty_loader* loader, const char* name, const ty_param_table* table, void* def); // or its defaults
ty_place ty_key_place(const ty_node* map, const char* key); // of its value, else of the mapping
void ty_read_light(ty_loader* loader, int index);
void ty_read_object(ty_loader* loader, int index);
// light_links.c
int ty_light_group_index(ty_loader* loader, const ty_node* name); // NULL = "default"
void ty_read_links(ty_loader* loader);                            // after lights, objects and materials
// Index of a light's image by file, space and wrap; the same for equal ones.
int ty_texture_index(ty_loader* loader, const ty_texture_def* def, ty_place place);

// asset_load.c: files to memory (everything named when only checking, else what objects use)
void ty_load_textures(ty_loader* loader);
void ty_load_assets(ty_loader* loader);
// scene_textures.c: textures of materials. Indices are the same for equal ones, -1 after a report. layer: the channel
// that alone counts, NULL = the picture; is_data: numbers, not colours.
int ty_surface_texture_of_asset(ty_loader* loader, int asset, const ty_node* name, const ty_node* layer, bool is_data);
int ty_surface_texture_of_file(ty_loader* loader, ty_node* name, const ty_node* layer, bool is_data,
                               const int wrap[2]); // along u and v, -1 = not said
void ty_load_surface_textures(ty_loader* loader);  // after the assets: recipes make frames
void ty_set_texture_times(ty_loader* loader);      // to the scene's seconds
// mesh_sequence.c: meshes that change with time
// When a sequence shows what, as textures and meshes understand it; and a report where the definition contradicts
// itself.
ty_mip_texture_def ty_sequence_timing(const ty_sequence_def* sequence);
void ty_sequence_check(ty_loader* loader, const ty_sequence_def* sequence, ty_place place);
// scene_coverage.c: what does not reach over the frames that will be asked for, or over the timeline where none are
// named, is reported.
void ty_check_sequence_covers(ty_loader* loader, const ty_mip_texture_def* timing, int frame_count, ty_place place);
void ty_check_keys_cover(ty_loader* loader); // named frames alone
// Numbers of a pattern's files; false after a report of what is missing, which begins with what.
bool ty_sequence_find_files(ty_loader* loader, const char* pattern, const ty_sequence_def* def, const char* what,
                            ty_place place, int* first, int* count);
void ty_mesh_sequence_read(ty_loader* loader, ty_asset* asset, const ty_mesh_asset_def* def, ty_node* pattern);
// Of a recipe that grows; the files come when it is made.
void ty_mesh_sequence_expect(ty_loader* loader, ty_asset* asset, const ty_mesh_asset_def* def);
void ty_mesh_sequence_load(ty_loader* loader, ty_asset* asset); // the mesh at the scene's seconds
void ty_mesh_sequence_destroy(struct ty_mesh_sequence* sequence);
void ty_set_mesh_times(ty_loader* loader);  // to the scene's seconds; what changed is marked
void ty_set_mesh_motion(ty_loader* loader); // mesh_motion.c: vertices over the open shutter, once that is known
bool ty_mesh_has_changed(const ty_loader* loader, const ty_mesh* mesh);
void ty_complete_mesh(const ty_loader* loader, ty_mesh* mesh); // what shading and tracing expect
void ty_convert_colors(const ty_loader* loader, ty_mesh* mesh);
// aggregate_sequence.c: aggregates that change with time
void ty_aggregate_sequence_read(ty_loader* loader, ty_asset* asset, const ty_aggregate_asset_def* def,
                                ty_node* pattern);
void ty_aggregate_sequence_load(ty_loader* loader, ty_asset* asset); // the instances at the scene's seconds
void ty_set_aggregate_times(ty_loader* loader);                      // to the scene's seconds, after the first load
// gltf_expand.c: glTF files that assets name, opened; their cameras and lights into the tree where objects ask for them
void ty_gltf_expand(ty_loader* loader);
// gltf_text.c: a scene of a glTF file alone, with light and a camera where it has none
bool ty_gltf_is_file(const char* path); // by extension
TY_CHECKED ty_status ty_gltf_scene_text(const char* path, ty_text* out, ty_error_list* errors);
// gltf_material.c: a glTF material as a mapping of the tree; NULL after a report
ty_node* ty_gltf_material_node(ty_loader* loader, const ty_asset* asset, int index);
// Text that this program made, as nodes that messages place at `place`.
ty_node* ty_made_node(ty_loader* loader, ty_place place, const char* text);
void ty_text_quote(ty_text* text, const char* word); // as JSON writes it
// scene_slots.c: the materials of each slot, once the meshes are known
void ty_resolve_slots(ty_loader* loader);
// scene_world.c: what objects show, once it is loaded
void ty_bind_objects(ty_loader* loader);
// attributes, objects, trees, depth fields, the shading context
void ty_build_attributes(ty_loader* loader);
void ty_compute_height(const ty_aggregate* aggregate, float* height); // [instance_count]
void ty_build_world(ty_loader* loader);
bool ty_world_is_stale(const ty_loader* loader); // objects moved, or are seen by others
void ty_rebuild_world(ty_loader* loader);        // the same objects, where they stand now

// scene_frame.c
void ty_forget_repeated(ty_error_list* errors, int from); // the same text at the same place
void ty_frame_read_timeline(ty_loader* loader);           // the section alone
void ty_frame_begin(ty_loader* loader);                   // the sections of time; the tree at the scene's frame
void ty_frame_check_keys(ty_loader* loader); // reads every keyed entry at every key: ranges hold everywhere then
void ty_pose_scene(ty_loader* loader);       // scene_motion.c: camera and objects over the open shutter
void ty_settle_moves(ty_loader* loader);     // whether anything does
void ty_frame_write_recipe(ty_loader* loader);
