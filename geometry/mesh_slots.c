// SPDX-License-Identifier: Apache-2.0
// Material slots: which material of its file each triangle has, by name.
#include <string.h>
#include <tsuya/geometry/mesh.h>

static int find_slot(const ty_mesh* mesh, const char* name)
{
    for (int i = 0; i < mesh->slot_count; i++)
        if (strcmp(mesh->slot_names[i], name) == 0)
            return i;
    return -1;
}

int ty_mesh_add_slot(ty_mesh* mesh, const char* name)
{
    int found = find_slot(mesh, name);
    if (found >= 0 || mesh->slot_count == TY_MESH_MAX_SLOTS)
        return found;
    size_t count = (size_t)mesh->slot_count;
    mesh->slot_names = ty_grow(mesh->slot_names, count, count + 1, sizeof(char*));
    mesh->slot_names[count] = ty_string_copy(name);
    return mesh->slot_count++;
}

static void drop_slots(ty_mesh* mesh)
{
    for (int i = 0; i < mesh->slot_count; i++)
        ty_free(mesh->slot_names[i]);
    ty_free(mesh->slot_names);
    mesh->slot_names = NULL;
    mesh->slot_count = 0;
}

// The numbers of mesh in the list of all; a mesh of no slots is one of the empty name.
static void renumber(ty_mesh* mesh, const ty_mesh* all)
{
    uint16_t numbers[TY_MESH_MAX_SLOTS] = {0};
    if (mesh->slot_count == 0)
        numbers[0] = (uint16_t)find_slot(all, "");
    for (int i = 0; i < mesh->slot_count; i++)
        numbers[i] = (uint16_t)find_slot(all, mesh->slot_names[i]);
    if (!mesh->slots)
        mesh->slots = TY_ALLOC(uint16_t, mesh->triangle_count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        mesh->slots[t] = numbers[mesh->slots[t]];
    drop_slots(mesh);
    mesh->slot_count = all->slot_count;
    mesh->slot_names = TY_ALLOC(char*, all->slot_count);
    for (int i = 0; i < all->slot_count; i++)
        mesh->slot_names[i] = ty_string_copy(all->slot_names[i]);
}

bool ty_mesh_share_slots(ty_mesh* const* meshes, int count)
{
    bool some = false, fits = true;
    ty_mesh all = {0};
    for (int i = 0; i < count; i++)
        some |= meshes[i]->slot_count > 0;
    for (int i = 0; some && i < count; i++)
    {
        if (meshes[i]->slot_count == 0)
            fits &= ty_mesh_add_slot(&all, "") >= 0;
        for (int k = 0; k < meshes[i]->slot_count; k++)
            fits &= ty_mesh_add_slot(&all, meshes[i]->slot_names[k]) >= 0;
    }
    for (int i = 0; fits && all.slot_count > 1 && i < count; i++)
        renumber(meshes[i], &all);
    drop_slots(&all);
    return fits;
}
