// SPDX-License-Identifier: Apache-2.0
// The tail of a message about an unknown name.
#include "nearest.h"
#include "text.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/suggest.h>

#define SEARCHED 2000 // names looked at: a message is no reason to search a million

const char* ty_nearest(const char* word, const char* const* names, int count, char buffer[TY_NEAREST_SIZE])
{
    buffer[0] = 0;
    if (count > SEARCHED)
        count = SEARCHED;
    const char* best = ty_suggest_name(word, names, count);
    if (best)
    {
        snprintf(buffer, TY_NEAREST_SIZE, "; did you mean '%.200s'?", best);
        return buffer;
    }
    ty_text text = {0};
    int shown = 0;
    for (int i = 0; i < count && text.size < TY_NEAREST_SIZE / 2; ++i)
        if (names[i])
            ty_text_format(&text, "%s%.100s", shown++ ? ", " : "; there are: ", names[i]);
    if (shown > 0)
        snprintf(buffer, TY_NEAREST_SIZE, "%s%s", text.data, shown < count ? " ..." : "");
    ty_text_term(&text);
    return buffer;
}

const char* ty_nearest_key(const char* word, const ty_node* map, char buffer[TY_NEAREST_SIZE])
{
    int count = map && map->kind == TY_NODE_MAP ? map->count : 0;
    if (count > SEARCHED)
        count = SEARCHED;
    const char** names = TY_ALLOC(const char*, count);
    for (int i = 0; i < count; ++i)
        names[i] = map->keys[i].text;
    ty_nearest(word, names, count, buffer);
    ty_free(names);
    return buffer;
}
