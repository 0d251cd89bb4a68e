// SPDX-License-Identifier: Apache-2.0
// A table of fixed size, for a signal may come at any moment. A forked child inherits the table but owns none of it.
#include "file_pending.h"
#include <errno.h>
#include <stdatomic.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <unistd.h>

enum
{
    SLOT_COUNT = 64,
};

typedef enum slot_state
{
    SLOT_FREE,
    SLOT_TAKEN, // path is being written
    SLOT_PENDING
} slot_state;

typedef struct pending_slot
{
    atomic_int state;
    pid_t owner;
    char path[TY_PATH_MAX];
} pending_slot;

static pending_slot slots[SLOT_COUNT];

int pending_add(const char* path)
{
    for (int i = 0; i < SLOT_COUNT; i++)
    {
        int state = SLOT_FREE;
        if (!atomic_compare_exchange_strong(&slots[i].state, &state, SLOT_TAKEN))
            continue;
        strcpy(slots[i].path, path);
        slots[i].owner = getpid();
        atomic_store(&slots[i].state, SLOT_PENDING);
        return i;
    }
    return -1;
}

void pending_drop(int slot)
{
    if (slot >= 0)
        atomic_store(&slots[slot].state, SLOT_FREE);
}

void ty_atomic_abort_all(void)
{
    int saved = errno;
    pid_t self = getpid();
    for (int i = 0; i < SLOT_COUNT; i++)
        if (atomic_load(&slots[i].state) == SLOT_PENDING && slots[i].owner == self && unlink(slots[i].path) != 0 &&
            errno == EISDIR)
            ty_folder_remove(slots[i].path);
    errno = saved;
}
