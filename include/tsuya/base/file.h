// SPDX-License-Identifier: Apache-2.0
// Files: bounded reading, atomic writing (temporary, fsync, rename), paths.
#pragma once
#include <stdint.h>
#include <tsuya/base/status.h>

#define TY_PATH_MAX 4096

typedef struct ty_bytes
{
    uint8_t* data; // owned, freed with ty_bytes_term; one zero byte follows the content
    size_t size;
} ty_bytes;

void ty_bytes_term(ty_bytes* bytes);

// Reads a whole regular file. A file over max_size, a directory, or an unreadable file is TY_BAD_FILE with the reason.
TY_CHECKED ty_status ty_file_read(const char* path, size_t max_size, ty_bytes* out, ty_error* error);
// How many bytes a regular file has; the same errors.
TY_CHECKED ty_status ty_file_size(const char* path, size_t* out, ty_error* error);

// An output that is complete or absent: write to .temporary, then commit. A process that ends by itself or by a signal
// that it handles leaves no temporary behind (ty_atomic_abort_all from an exit path removes what is pending).
typedef struct ty_atomic_file
{
    char path[TY_PATH_MAX];
    char temporary[TY_PATH_MAX]; // beside path, with the same extension, so that libraries see the right type
    int slot;                    // in the table of pending temporaries
} ty_atomic_file;

// Fails early when the folder is missing or not writable or path is a directory, a device or a pipe. A link is
// followed. The temporary exists (empty) afterwards. At most 64 are pending at a time. Callable from any thread.
TY_CHECKED ty_status ty_atomic_begin(ty_atomic_file* file, const char* path, ty_error* error);
// fsync, rename, fsync of the folder. On failure the temporary is gone and the old file as it was.
TY_CHECKED ty_status ty_atomic_commit(ty_atomic_file* file, ty_error* error);
void ty_atomic_abort(ty_atomic_file* file); // removes the temporary; harmless after a commit or a failed begin
void ty_atomic_abort_all(void);             // async-signal-safe; removes only what this process began

// A folder that is complete or absent: write files into .temporary, then commit.
typedef struct ty_atomic_folder
{
    char path[TY_PATH_MAX];
    char temporary[TY_PATH_MAX]; // beside path; empty = nothing is pending
    int slot;                    // in the table of pending temporaries
} ty_atomic_folder;

TY_CHECKED ty_status ty_atomic_folder_begin(ty_atomic_folder* folder, const char* path, ty_error* error);
// Renames; a folder that stands there is replaced in one step and removed with the files in it.
TY_CHECKED ty_status ty_atomic_folder_commit(ty_atomic_folder* folder, ty_error* error);
void ty_atomic_folder_abort(ty_atomic_folder* folder); // removes the temporary; harmless after a commit

TY_CHECKED ty_status ty_file_write(const char* path, const void* bytes, size_t size, ty_error* error); // atomic
// All bytes to a descriptor, through interruptions and short writes. False: errno tells.
bool ty_descriptor_write(int fd, const void* bytes, size_t size);
TY_CHECKED ty_status ty_folder_create(const char* path, ty_error* error); // with parents; existing is fine

// Removes a folder and the files in it; folders in it are left, and it with them. Links are not followed.
void ty_folder_remove(const char* path);

// Files that only save time: takes the regular ones with that extension from a folder, those untouched for longest
// first, until the others hold at most `most` bytes together. What cannot be read or removed stays.
void ty_folder_trim(const char* folder, const char* extension, uint64_t most);
void ty_file_touch(const char* path); // it has been used now; without the right to say so nothing happens

bool ty_file_exists(const char* path); // a regular file
bool ty_folder_exists(const char* path);
const char* ty_path_extension(const char* path); // "exr", without the dot; "" if none
// Paths that do not fit out become the empty path, which names nothing.
void ty_path_folder(const char* path, char out[TY_PATH_MAX]);                   // "." if none
void ty_path_join(const char* folder, const char* name, char out[TY_PATH_MAX]); // name absolute: name alone

// Sequences: the last run of '#' in the name of the file stands for the number of the frame, with at least as many
// digits as the run is long ("fill.####.exr", 7: "fill.0007.exr"; -7: "fill.-007.exr"). Without a run the path stays as
// it is.
bool ty_path_is_sequence(const char* path);
void ty_path_frame(const char* pattern, int frame, char out[TY_PATH_MAX]);

typedef struct ty_frame_numbers
{
    int* numbers; // ascending, each once; owned, freed with ty_frame_numbers_term
    int count;
} ty_frame_numbers;

// The frames of a pattern that are there as regular files. None at all (or no such folder) is TY_BAD_FILE.
TY_CHECKED ty_status ty_frame_numbers_find(const char* pattern, ty_frame_numbers* out, ty_error* error);
void ty_frame_numbers_term(ty_frame_numbers* frames);
// Their numbers as "7, 12-14", ending in "..." when size does not suffice.
void ty_frame_numbers_text(const ty_frame_numbers* frames, char* text, size_t size);
// How many from first to last are not there, and which, in such a text.
int ty_frame_numbers_missing(const ty_frame_numbers* frames, int first, int last, char* text, size_t size);

// Runs fn in a child process with limits: for importers of foreign code. What fn writes to output_fd becomes *output
// (at most max_output bytes). A crash, limit or timeout is TY_BAD_FILE with the reason; a failure of fn brings its
// ty_error. A cancel request ends the child with TY_INTERRUPTED or TY_TERMINATED. fn must not touch threads; what it
// prints on standard output is dropped. def NULL = all defaults. Memory limits are not applied under AddressSanitizer.
typedef struct ty_child_def
{
    size_t memory_bytes; // address space above the present; 0 = 4 GiB
    double seconds;      // wall clock; 0 = 60
    size_t max_output;   // bytes; 0 = 2 GiB
} ty_child_def;
typedef ty_status ty_child_fn(const void* context, int output_fd, ty_error* error);
TY_CHECKED ty_status ty_child_run(const ty_child_def* def, ty_child_fn* fn, const void* context, ty_bytes* output,
                                  ty_error* error);
// For fn: writes all bytes to the pipe.
TY_CHECKED ty_status ty_child_write(int output_fd, const void* bytes, size_t size, ty_error* error);
