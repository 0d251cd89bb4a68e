// SPDX-License-Identifier: Apache-2.0
// What the commands share: options, numbers, results as JSON, signals.
#pragma once
#include <jansson.h>
#include <stdio.h>
#include <tsuya/base/status.h>
#include <tsuya/image/exr.h>
#include <tsuya/scene/scene.h>

typedef struct ty_option
{
    const char* name;  // long, without dashes
    char short_name;   // 0 = none
    const char* value; // what stands for the value in help; NULL = a flag
    const char* help;
} ty_option;

typedef struct ty_command ty_command;

typedef struct ty_given
{
    const ty_option* option;
    const char* text; // "" for flags
} ty_given;

// A parsed command line. Texts are borrowed from argv.
typedef struct ty_arguments
{
    const ty_command* command;
    ty_given given[256];
    int given_count;
    const char* positional[256];
    int positional_count;
} ty_arguments;

struct ty_command
{
    const char* name;
    const char* usage;   // what follows the name
    const char* summary; // one line
    const char* example; // one runnable line
    int least, most;     // positional arguments
    const ty_option* options;
    int option_count;
    ty_status (*run)(const ty_arguments* arguments);
};

// On failure the message has been logged.
TY_CHECKED ty_status ty_arguments_parse(const ty_command* command, int argc, char** argv, ty_arguments* out);
void ty_command_help(const ty_command* command);

bool ty_argument_has(const ty_arguments* arguments, const char* name);
const char* ty_argument_text(const ty_arguments* arguments, const char* name, const char* fallback); // the last one
// Numbers: the option must be given. Logged TY_USAGE with the accepted range when it is no number or outside.
TY_CHECKED ty_status ty_argument_int(const ty_arguments* arguments, const char* name, long low, long high, long* out);
TY_CHECKED ty_status ty_argument_float(const ty_arguments* arguments, const char* name, double low, double high,
                                       double* out);
// A list "0.1,0.2", with ranges "FROM:TO:COUNT", of 1..most numbers from low to high.
TY_CHECKED ty_status ty_argument_numbers(const ty_arguments* arguments, const char* name, double low, double high,
                                         int most, double* out, int* count);
// "512MB", "1.5GB" (decimal), "2GiB", or bytes.
TY_CHECKED ty_status ty_argument_bytes(const ty_arguments* arguments, const char* name, double low, double high,
                                       uint64_t* out);
// Logs "tsuya COMMAND: text" and returns TY_USAGE.
ty_status ty_usage(const ty_command* command, const char* format, ...) TY_PRINTF(2, 3);

// The options every command that loads a scene understands, and what they say. Free with ty_scene_arguments_term.
#define TY_SCENE_OPTIONS                                                                                               \
    {"define", 'D', "NAME=VALUE", "set a variable of the scene (repeatable)"},                                         \
        {"set", 0, "PATH=VALUE", "override any parameter, e.g. camera.vfov=20 (repeatable)"},                          \
        {"ocio", 0, "FILE", "OpenColorIO configuration"},                                                              \
        {"cache", 0, "FOLDER", "where made assets are kept; none: nowhere"},                                           \
        {"texture-cache", 0, "SIZE", "memory for textures, e.g. 512MB (default 1GB)"},                                 \
        {"sandbox", 0, NULL, "allow no file outside the scene's folder"},                                              \
    {                                                                                                                  \
        "threads", 't', "N", "worker threads (default: all cores)"                                                     \
    }

typedef struct ty_scene_arguments
{
    const char* sets[300];
    const char* variables[256];
    char texts[16][96]; // for options that are short forms of --set
    int text_count;
    ty_scene_options options;
} ty_scene_arguments;

// Fills options from the arguments; workers are created here (owned by *out).
TY_CHECKED ty_status ty_scene_arguments_read(const ty_arguments* arguments, ty_scene_arguments* out);
// A further override, as if --set had been given.
void ty_scene_arguments_set(ty_scene_arguments* arguments, const char* format, ...) TY_PRINTF(2, 3);
void ty_scene_arguments_term(ty_scene_arguments* arguments);
// Loads and reports: on failure all mistakes have been logged and the status is the first one's.
TY_CHECKED ty_status ty_scene_open(const char* path, const ty_scene_options* options, ty_scene** out);

void ty_scene_warn(const ty_scene* scene); // of what is no mistake, but gives no picture
void ty_errors_log(ty_error_list* errors); // logs and frees

// A JSON string of any text, such as the name of a file or a message that was cut within a character: what is no UTF-8
// becomes U+FFFD, where jansson would give nothing.
json_t* ty_json_from_text(const char* text);
json_t* ty_json_format(const char* format, ...) TY_PRINTF(1, 2);
// Prints value as indented JSON on standard output and releases it.
TY_CHECKED ty_status ty_json_print(json_t* value);
// Writes it to a file, atomically, and releases it.
TY_CHECKED ty_status ty_json_write(const char* path, json_t* value);
// What was made as figures, the text of a JSON object: to the file of --report, and to standard output, as JSON with
// --json, else the name of the output and what print makes of them.
TY_CHECKED ty_status ty_report_give(const ty_arguments* arguments, const char* output, const char* text,
                                    void (*print)(const json_t* report));
// info_metrics.c: the metrics of an aggregate as lines of words with units; those without words keep their names.
void ty_info_print_metrics(const json_t* values, int indent);
// Whether the path ends in one of the endings (up to NULL); else a usage mistake that lists them.
TY_CHECKED ty_status ty_output_check_ending(const ty_command* command, const char* output, const char* const* endings);
extern const char* const ty_state_endings[]; // of what a run of frames goes on from
typedef enum ty_output_form
{
    TY_OUTPUT_FILE,   // one, without #
    TY_OUTPUT_FRAMES, // with # for the number
    TY_OUTPUT_EITHER,
} ty_output_form;
// Whether a command may write there, before minutes of work: its ending (endings NULL: any), its form, its folder. what
// it is called in messages: "output", "state". path NULL: the command's first option is missing. Logged.
TY_CHECKED ty_status ty_output_check(const ty_command* command, const char* what, const char* path,
                                     const char* const* endings, ty_output_form form);
// Whether they are files of their own; NULL among the paths: not given. names: as what of ty_output_check. Logged.
TY_CHECKED ty_status ty_output_check_apart(const ty_command* command, const char* const* names,
                                           const char* const* paths, int count);
// Whether a file can be written at path; leaves nothing there.
TY_CHECKED ty_status ty_output_probe(const char* path, ty_error* error);
// A file that is complete or absent, written as a stream. A failure of put, or of the disk, leaves the old one.
typedef ty_status ty_output_fn(FILE* file, const void* context, ty_error* error);
TY_CHECKED ty_status ty_output_write(const char* path, ty_output_fn* put, const void* context, ty_error* error);
// Flushes standard output and says whether everything arrived.
TY_CHECKED ty_status ty_output_finish(void);

// Develops an EXR's R, G, B (or Y) into image file `output`. Display, view NULL = defaults.
typedef struct ty_develop_def
{
    const char* display;
    const char* view;
    const char* ocio;
    float exposure; // stops
    int bits;       // 8 or 16
} ty_develop_def;
// From --display, --view, --exposure, --bits and --ocio.
TY_CHECKED ty_status ty_develop_options(const ty_arguments* arguments, ty_develop_def* def);
// Whether there are such a display and view: known before anything is rendered. A mistake is logged.
TY_CHECKED ty_status ty_develop_check(const ty_develop_def* def);
// Scene-linear pixels of 3 or 4 channels to display values, in place.
TY_CHECKED ty_status ty_develop_pixels(const ty_develop_def* def, float* pixels, int count, int channels,
                                       ty_error* error);
TY_CHECKED ty_status ty_develop(const ty_exr* exr, const ty_develop_def* def, const char* output, ty_error* error);

// A small picture of roots on their host. roots: a mesh, or the pattern of frames, of which the last is shown. Logged.
TY_CHECKED ty_status ty_roots_picture(const char* output, const char* roots, const char* host,
                                      const ty_scene_options* options);

void ty_signals_install(void);

extern const ty_command ty_command_render, ty_command_develop, ty_command_merge, ty_command_check, ty_command_info,
    ty_command_params, ty_command_pack, ty_command_fill, ty_command_filter, ty_command_loop, ty_command_roots,
    ty_command_export, ty_command_doctor;
extern const ty_command ty_command_compare, ty_command_regress;
extern const ty_command ty_command_turntable, ty_command_sweep;
extern const ty_command ty_command_moisture, ty_command_calibrate;
