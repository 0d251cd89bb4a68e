// SPDX-License-Identifier: Apache-2.0
// Optimal string alignment distance (Damerau-Levenshtein without repeated edits) over short words.
#include <ctype.h>
#include <stdbool.h>
#include <string.h>
#include <tsuya/base/suggest.h>

enum
{
    LONGEST = 64
};

static int lower(char c)
{
    return tolower((unsigned char)c);
}

static int least(int a, int b, int c)
{
    int m = a < b ? a : b;
    return m < c ? m : c;
}

static int edit_distance(const char* a, int a_length, const char* b, int b_length)
{
    int rows[3][LONGEST + 1];
    int *before = rows[0], *above = rows[1], *row = rows[2];
    for (int j = 0; j <= b_length; j++)
    {
        above[j] = j;
        before[j] = 0;
    }
    for (int i = 1; i <= a_length; i++)
    {
        row[0] = i;
        for (int j = 1; j <= b_length; j++)
        {
            int change = lower(a[i - 1]) != lower(b[j - 1]);
            row[j] = least(above[j] + 1, row[j - 1] + 1, above[j - 1] + change);
            bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
            if (swapped && before[j - 2] + 1 < row[j])
            {
                row[j] = before[j - 2] + 1;
            }
        }
        int* recycled = before;
        before = above;
        above = row;
        row = recycled;
    }
    return above[b_length];
}

const char* ty_suggest_name(const char* word, const char* const* names, int count)
{
    int length = (int)strlen(word);
    if (length == 0 || length > LONGEST)
    {
        return NULL;
    }
    int best_distance = length / 3 > 1 ? length / 3 + 1 : 2;
    const char* best = NULL;
    for (int i = 0; i < count; i++)
    {
        int name_length = names[i] ? (int)strlen(names[i]) : LONGEST + 1;
        if (name_length > LONGEST)
        {
            continue;
        }
        int distance = edit_distance(word, length, names[i], name_length);
        if (distance < best_distance)
        {
            best_distance = distance;
            best = names[i];
        }
    }
    return best;
}
