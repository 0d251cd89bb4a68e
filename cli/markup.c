// SPDX-License-Identifier: Apache-2.0
// Escaping, and bytes as text.
#include "markup.h"

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
