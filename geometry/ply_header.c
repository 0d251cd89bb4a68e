// SPDX-License-Identifier: Apache-2.0
// PLY headers and bounded reading of values.
#include "ply.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const int type_sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};

ty_status ply_fail(ply_file* file, const char* format, ...)
{
    char text[400];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (file->format == PLY_ASCII)
    {
        return ty_error_set_at(file->error, TY_BAD_FILE, file->name, file->line, 0, "%s", text);
    }
    return ty_error_set_at(file->error, TY_BAD_FILE, file->name, 0, 0, "at byte %zu: %s", file->offset, text);
}

static ply_type type_from_name(const char* name)
{
    static const char* const names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                           {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                           {"float", "float32"}, {"double", "float64"}};
    for (int i = 0; i < PLY_NO_TYPE; i++)
    {
        if (strcmp(name, names[i][0]) == 0 || strcmp(name, names[i][1]) == 0)
        {
            return (ply_type)i;
        }
    }
    return PLY_NO_TYPE;
}

// The next header line without its end into out; false = no line end within the file or the line is too long.
static bool next_line(ply_file* file, char out[256])
{
    size_t length = 0;
    while (file->offset < file->size)
    {
        char c = (char)file->bytes[file->offset++];
        if (c == '\n')
        {
            length -= length > 0 && out[length - 1] == '\r';
            out[length] = '\0';
            file->line++;
            return true;
        }
        if (length == 255 || c == '\0')
        {
            return false;
        }
        out[length++] = c;
    }
    return false;
}

static ty_status parse_format(ply_file* file, const char* text)
{
    static const char* const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    for (int i = 0; i < 3; i++)
    {
        if (strcmp(text, names[i]) == 0)
        {
            file->data_format = (ply_format)i;
            return TY_OK;
        }
    }
    return ply_fail(file, "unknown format '%s' (ascii, binary_little_endian, binary_big_endian)", text);
}

static ty_status parse_element(ply_file* file, const char* name, const char* count)
{
    if (file->element_count == PLY_MAX_ELEMENTS)
    {
        return ply_fail(file, "more than %d elements", PLY_MAX_ELEMENTS);
    }
    char* end;
    unsigned long long value = strtoull(count, &end, 10);
    if (end == count || *end || count[0] == '-' || value > 0xfffffffeull)
    {
        return ply_fail(file, "element %s: '%s' is not a count", name, count);
    }
    ply_element* element = &file->elements[file->element_count++];
    memset(element, 0, sizeof *element);
    snprintf(element->name, sizeof element->name, "%s", name);
    element->count = value;
    return TY_OK;
}

static ty_status add_property(ply_file* file, const char* type, const char* count_type, const char* name)
{
    if (file->element_count == 0)
    {
        return ply_fail(file, "property '%s' before any element", name);
    }
    ply_element* element = &file->elements[file->element_count - 1];
    ply_property property = {.type = type_from_name(type),
                             .count_type = count_type ? type_from_name(count_type) : PLY_NO_TYPE};
    if (property.type == PLY_NO_TYPE || (count_type && property.count_type >= PLY_FLOAT32))
    {
        return ply_fail(file, "property '%s' has an unknown type", name);
    }
    if (element->property_count == PLY_MAX_PROPERTIES)
    {
        return ply_fail(file, "element %s has more than %d properties", element->name, PLY_MAX_PROPERTIES);
    }
    if (ply_find_property(element, name) >= 0)
    {
        return ply_fail(file, "property '%s' appears twice", name);
    }
    snprintf(property.name, sizeof property.name, "%s", name);
    element->properties[element->property_count++] = property;
    return TY_OK;
}

static ty_status parse_line(ply_file* file, char* text)
{
    char word[5][64] = {{0}};
    int words = sscanf(text, "%63s %63s %63s %63s %63s", word[0], word[1], word[2], word[3], word[4]);
    if (words >= 1 && (strcmp(word[0], "comment") == 0 || strcmp(word[0], "obj_info") == 0))
    {
        return TY_OK;
    }
    if (words == 3 && strcmp(word[0], "format") == 0)
    {
        return parse_format(file, word[1]);
    }
    bool named = words > 1 && strlen(word[words - 1]) < PLY_NAME_SIZE;
    if (words == 3 && strcmp(word[0], "element") == 0 && strlen(word[1]) < PLY_NAME_SIZE)
    {
        return parse_element(file, word[1], word[2]);
    }
    if (words == 3 && strcmp(word[0], "property") == 0 && named)
    {
        return add_property(file, word[1], NULL, word[2]);
    }
    if (words == 5 && strcmp(word[0], "property") == 0 && strcmp(word[1], "list") == 0 && named)
    {
        return add_property(file, word[3], word[2], word[4]);
    }
    return ply_fail(file, "not a PLY header line: '%.80s'", text);
}

ty_status ply_open(ply_file* file, const char* name, const void* bytes, size_t size, ty_error* error)
{
    *file = (ply_file){.name = name, .bytes = bytes, .size = size, .format = PLY_ASCII, .error = error};
    char text[256];
    if (!next_line(file, text) || strcmp(text, "ply") != 0)
    {
        return ply_fail(file, size == 0 ? "the file is empty" : "not a PLY file: it does not begin with 'ply'");
    }
    for (;;)
    {
        if (!next_line(file, text))
        {
            return ply_fail(file, "the header does not end");
        }
        if (strcmp(text, "end_header") == 0)
        {
            file->format = file->data_format;
            file->line++; // reading goes on in the next one
            file->header_size = file->offset;
            return TY_OK;
        }
        ty_status status = parse_line(file, text);
        if (status != TY_OK)
        {
            return status;
        }
    }
}

ty_status ply_check_room(ply_file* file, const ply_element* element)
{
    uint64_t least = 0;
    for (int i = 0; i < element->property_count; i++)
    {
        const ply_property* property = &element->properties[i];
        ply_type type = property->count_type == PLY_NO_TYPE ? property->type : property->count_type;
        least += file->format == PLY_ASCII ? 2 : (uint64_t)type_sizes[type];
    }
    uint64_t room = file->size - file->offset + 1; // the last line may lack its end
    if (element->count > room / (least ? least : 1))
    {
        return ply_fail(file, "%llu items of element %s cannot be in the %zu bytes that are left",
                        (unsigned long long)element->count, element->name, file->size - file->offset);
    }
    return TY_OK;
}

static ty_status read_text(ply_file* file, double* out)
{
    while (file->offset < file->size && strchr(" \t\r\n", file->bytes[file->offset]) && file->bytes[file->offset])
    {
        file->line += file->bytes[file->offset++] == '\n';
    }
    char word[64];
    size_t length = 0;
    while (file->offset < file->size && file->bytes[file->offset] > ' ' && length < sizeof word - 1)
    {
        word[length++] = (char)file->bytes[file->offset++];
    }
    word[length] = '\0';
    if (length == 0)
    {
        return ply_fail(file, "the file ends too early");
    }
    char* end;
    *out = strtod(word, &end);
    return *end ? ply_fail(file, "'%s' is not a number", word) : TY_OK;
}

static uint64_t read_bits(const uint8_t* bytes, int size, bool big)
{
    uint64_t bits = 0;
    for (int i = 0; i < size; i++)
    {
        bits |= (uint64_t)bytes[big ? size - 1 - i : i] << (8 * i);
    }
    return bits;
}

static double from_bits(uint64_t bits, ply_type type)
{
    uint32_t low = (uint32_t)bits;
    float single;
    double wide;
    switch (type)
    {
    case PLY_INT8:
        return (int8_t)low;
    case PLY_INT16:
        return (int16_t)low;
    case PLY_INT32:
        return (int32_t)low;
    case PLY_FLOAT32:
        memcpy(&single, &low, sizeof single);
        return (double)single;
    case PLY_FLOAT64:
        memcpy(&wide, &bits, sizeof wide);
        return wide;
    case PLY_UINT8:
    case PLY_UINT16:
    case PLY_UINT32:
    case PLY_NO_TYPE:
        break;
    }
    return (double)low;
}

ty_status ply_read_value(ply_file* file, ply_type type, double* out)
{
    if (file->format == PLY_ASCII)
    {
        return read_text(file, out);
    }
    size_t size = (size_t)type_sizes[type]; // NOLINT: the header gave every property a type
    if (file->size - file->offset < size)
    {
        return ply_fail(file, "the file ends too early");
    }
    *out = from_bits(read_bits(file->bytes + file->offset, (int)size, file->format == PLY_BIG), type);
    file->offset += size;
    return TY_OK;
}

ty_status ply_skip_element(ply_file* file, const ply_element* element)
{
    for (uint64_t item = 0; item < element->count; item++)
    {
        for (int i = 0; i < element->property_count; i++)
        {
            const ply_property* property = &element->properties[i];
            double value, count = 1;
            ty_status status = TY_OK;
            if (property->count_type != PLY_NO_TYPE)
            {
                status = ply_read_value(file, property->count_type, &count);
            }
            for (double k = 0; k < count && status == TY_OK; k++)
            {
                status = ply_read_value(file, property->type, &value);
            }
            if (status != TY_OK)
            {
                return status;
            }
        }
    }
    return TY_OK;
}

int ply_find_property(const ply_element* element, const char* name)
{
    for (int i = 0; i < element->property_count; i++)
    {
        if (strcmp(element->properties[i].name, name) == 0)
        {
            return i;
        }
    }
    return -1;
}
