// SPDX-License-Identifier: Apache-2.0
// Escaping, and files written as a stream.
#include "markup.h"
#include <errno.h>
#include <string.h>
#include <tsuya/base/file.h>

void ty_markup_text(FILE* file, const char* text)
{
    for (; *text; text++)
    {
        unsigned char c = (unsigned char)*text;
        switch (c)
        {
        case '<':
            fputs("&lt;", file);
            break;
        case '>':
            fputs("&gt;", file);
            break;
        case '&':
            fputs("&amp;", file);
            break;
        case '"':
            fputs("&quot;", file);
            break;
        case '\n':
        case '\t':
            fprintf(file, "&#%d;", c);
            break;
        default:
            fputc(c < 32 ? '?' : c, file);
        }
    }
}

void ty_markup_base64(FILE* file, const ty_bytes* bytes)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < bytes->size; i += 3)
    {
        size_t left = bytes->size - i;
        uint32_t word = (uint32_t)bytes->data[i] << 16;
        word |= left > 1 ? (uint32_t)bytes->data[i + 1] << 8 : 0;
        word |= left > 2 ? bytes->data[i + 2] : 0;
        const char four[4] = {digits[word >> 18], digits[word >> 12 & 63], left > 1 ? digits[word >> 6 & 63] : '=',
                              left > 2 ? digits[word & 63] : '='};
        fwrite(four, 1, 4, file);
    }
}

ty_status ty_markup_write(const char* path, ty_markup_fn* put, const void* context, ty_error* error)
{
    static ty_atomic_file output; // paths: too large for the stack
    ty_status status = ty_atomic_begin(&output, path, error);
    if (status != TY_OK)
    {
        return status;
    }
    FILE* file = fopen(output.temporary, "wb");
    if (file)
    {
        status = put(file, context, error);
    }
    bool bad = !file || ferror(file);
    if (file)
    {
        bad |= fclose(file) != 0;
    }
    if (status == TY_OK && bad)
    {
        status = ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot write: %s", strerror(errno));
    }
    if (status == TY_OK)
    {
        return ty_atomic_commit(&output, error);
    }
    ty_atomic_abort(&output);
    return status;
}
