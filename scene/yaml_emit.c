// SPDX-License-Identifier: Apache-2.0
// Canonical text of a tree: the same tree gives the same bytes, and reading them gives the same tree.
#include "text.h"
#include "yaml_tree.h"
#include <ctype.h>
#include <string.h>

// Whether text needs no quotes as a key or value, in block and flow style alike.
static bool is_plain(const char* text)
{
    unsigned char first = (unsigned char)text[0], second = first ? (unsigned char)text[1] : 0;
    if (!first || (!isalnum(first) && !strchr("_./+$-", first)) || (first == '-' && !isdigit(second) && second != '.'))
        return false;
    // "..." ends a document
    if (strncmp(text, "...", 3) == 0 || strncmp(text, "-.", 2) == 0)
        return isdigit((unsigned char)text[2]) != 0;
    for (const char* c = text; *c; ++c)
        if (!isalnum((unsigned char)*c) && !strchr("_./+$-", *c))
            return false;
    return true;
}

static void emit_quoted(ty_text* out, const char* text)
{
    ty_text_add(out, "\"");
    for (const char* c = text; *c; ++c)
    {
        unsigned char byte = (unsigned char)*c;
        if (byte == '"' || byte == '\\')
            ty_text_format(out, "\\%c", byte);
        else if (byte == '\n')
            ty_text_add(out, "\\n");
        else if (byte < 0x20 || byte == 0x7f)
            ty_text_format(out, "\\x%02x", byte);
        else
            ty_text_add_bytes(out, c, 1);
    }
    ty_text_add(out, "\"");
}

static void emit_word(ty_text* out, const char* text)
{
    if (is_plain(text))
        ty_text_add(out, text);
    else
        emit_quoted(out, text);
}

// A text that begins with $ would be read as a variable.
static void emit_scalar(ty_text* out, const char* text)
{
    if (text[0] != '$')
    {
        emit_word(out, text);
        return;
    }
    ty_text escaped = {0};
    ty_text_format(&escaped, "$%s", text);
    emit_word(out, escaped.data);
    ty_text_term(&escaped);
}

static bool is_flow(const ty_node* node)
{
    if (node->kind == TY_NODE_SCALAR || node->count == 0)
        return true;
    if (node->kind == TY_NODE_MAP)
        return false;
    for (int i = 0; i < node->count; ++i)
        if (!is_flow(node->items[i]))
            return false;
    return true;
}

static void emit_flow(ty_text* out, const ty_node* node)
{
    if (node->kind == TY_NODE_SCALAR)
        emit_scalar(out, node->text);
    else if (node->kind == TY_NODE_MAP)
        ty_text_add(out, "{}");
    else
    {
        ty_text_add(out, "[");
        for (int i = 0; i < node->count; ++i)
        {
            ty_text_add(out, i ? ", " : "");
            emit_flow(out, node->items[i]);
        }
        ty_text_add(out, "]");
    }
}

// The first line stands where the text is; further ones are indented by indent.
static void emit_block(ty_text* out, const ty_node* node, int indent)
{
    for (int i = 0; i < node->count; ++i)
    {
        const ty_node* item = node->items[i];
        if (i)
            ty_text_repeat(out, ' ', indent);
        if (node->kind == TY_NODE_MAP)
        {
            emit_word(out, node->keys[i].text);
            ty_text_add(out, ":");
        }
        else
            ty_text_add(out, "-");
        if (is_flow(item))
        {
            ty_text_add(out, " ");
            emit_flow(out, item);
            ty_text_add(out, "\n");
        }
        else if (node->kind == TY_NODE_MAP)
        {
            ty_text_add(out, "\n");
            ty_text_repeat(out, ' ', indent + 2);
            emit_block(out, item, indent + 2);
        }
        else
        {
            ty_text_add(out, " ");
            emit_block(out, item, indent + 2);
        }
    }
}

char* ty_tree_emit(const ty_node* root)
{
    ty_text out = {0};
    if (is_flow(root))
    {
        emit_flow(&out, root);
        ty_text_add(&out, "\n");
    }
    else
        emit_block(&out, root, 0);
    return ty_text_take(&out);
}
