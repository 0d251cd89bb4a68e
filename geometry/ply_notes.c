// SPDX-License-Identifier: Apache-2.0
// Texts in the comments of a PLY header: what made the file. A line of the text is a comment "tsuya KEY: line"; what is
// longer goes on in comments "tsuya KEY+ line".
#include "ply.h"
#include <stdio.h>
#include <string.h>

enum
{
    LINE = 160 // bytes of text in a comment: readers, ours too, have bounds
};

size_t ply_note_bound(const char* text)
{
    size_t lines = 1, length = text ? strlen(text) : 0;
    for (const char* c = text; c && *c; c++)
    {
        lines += *c == '\n';
    }
    return text ? length + 64 * (lines + length / LINE) : 0;
}

char* ply_note_write(const char* key, const char* text, char* out)
{
    while (text && *text)
    {
        const char* end = strchrnul(text, '\n');
        char mark = ':';
        do
        {
            int length = end - text > LINE ? LINE : (int)(end - text);
            out += sprintf(out, "comment tsuya %s%c %.*s\n", key, mark, length, text);
            text += length;
            mark = '+';
        } while (text < end);
        text += *text == '\n';
    }
    return out;
}

char* ply_note_read(const ply_file* file, const char* key)
{
    char begin[64];
    size_t size = (size_t)snprintf(begin, sizeof begin, "comment tsuya %s", key), used = 0;
    char* text = TY_TRY_ALLOC(char, file->header_size + 2);
    const char *line = (const char*)file->bytes, *header_end = line + file->header_size;
    while (text && line < header_end)
    {
        const char* end = memchr(line, '\n', (size_t)(header_end - line));
        end = end ? end : header_end;
        size_t length = (size_t)(end - line);
        bool is_ours = length >= size + 2 && memcmp(line, begin, size) == 0 && line[size + 1] == ' ';
        if (is_ours && (line[size] == ':' || line[size] == '+'))
        {
            used -= line[size] == '+' && used > 0; // over the line end
            memcpy(text + used, line + size + 2, length - size - 2);
            used += length - size - 2;
            text[used++] = '\n';
        }
        line = end + 1;
    }
    if (used > 0)
    {
        text[used] = 0;
        return text;
    }
    ty_free(text);
    return NULL;
}
