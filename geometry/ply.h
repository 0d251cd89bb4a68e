// SPDX-License-Identifier: Apache-2.0
// The parts of the PLY reader: header, a bounded cursor over the data, and point files.
#pragma once
#include <stdint.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/status.h>

enum
{
    PLY_MAX_PROPERTIES = 64,
    PLY_MAX_ELEMENTS = 16,
    PLY_NAME_SIZE = 32
};

typedef enum ply_type
{
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT32,
    PLY_FLOAT64,
    PLY_NO_TYPE
} ply_type;

typedef enum ply_format
{
    PLY_ASCII,
    PLY_LITTLE,
    PLY_BIG
} ply_format;

typedef struct ply_property
{
    char name[PLY_NAME_SIZE];
    ply_type type;
    ply_type count_type; // PLY_NO_TYPE = a scalar, else a list
} ply_property;

typedef struct ply_element
{
    char name[PLY_NAME_SIZE];
    uint64_t count;
    ply_property properties[PLY_MAX_PROPERTIES];
    int property_count;
} ply_element;

// A file being read. Every read is bounded by size; the first fault is kept in error and ends the reading.
typedef struct ply_file
{
    const char* name; // for messages
    const uint8_t* bytes;
    size_t size, offset;
    int line;               // of offset, ascii and header
    ply_format format;      // of what is being read: the header is text
    ply_format data_format; // of what follows it
    size_t header_size;
    ply_element elements[PLY_MAX_ELEMENTS];
    int element_count;
    ty_error* error;
} ply_file;

// On success offset stands at the first element's data.
TY_CHECKED ty_status ply_open(ply_file* file, const char* name, const void* bytes, size_t size, ty_error* error);
// Fails with the place: line for text, byte offset for binary.
ty_status ply_fail(ply_file* file, const char* format, ...) TY_PRINTF(2, 3);
// Whether the rest of the file can hold the element's items at all; to be asked before memory is taken.
TY_CHECKED ty_status ply_check_room(ply_file* file, const ply_element* element);
TY_CHECKED ty_status ply_read_value(ply_file* file, ply_type type, double* out);
TY_CHECKED ty_status ply_skip_element(ply_file* file, const ply_element* element);
// Texts that our own files carry in comments. Writing needs room for ply_note_bound bytes; text NULL writes nothing.
size_t ply_note_bound(const char* text);
char* ply_note_write(const char* key, const char* text, char* out);  // returns the end of what was written
char* ply_note_read(const ply_file* file, const char* key);          // caller frees; NULL = none, or no memory
int ply_find_property(const ply_element* element, const char* name); // -1 = none

typedef struct ty_mesh ty_mesh;
// crease: of the normals where the file has none, in radians; at pi no vertex is split.
TY_CHECKED ty_status ply_read(const char* name, const void* bytes, size_t size, float crease, ty_mesh** out,
                              ty_error* error);

typedef struct ply_points
{
    uint64_t count;
    int column_count;
    char names[PLY_MAX_PROPERTIES][PLY_NAME_SIZE]; // every scalar property, x y z among them
    float* columns[PLY_MAX_PROPERTIES];            // [count] each, owned
} ply_points;

// The vertex element of a file, faces or not. On failure out is empty.
TY_CHECKED ty_status ply_read_points(const char* name, const void* bytes, size_t size, ply_points* out,
                                     ty_error* error);
void ply_points_term(ply_points* points);
const float* ply_points_column(const ply_points* points, const char* name); // NULL = none
