// SPDX-License-Identifier: Apache-2.0
// What converted files end in: their size and hash, by which a file that was cut off or changed is known.
#include "mip_seal.h"
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>
#include <unistd.h>

enum
{
    CHUNK = 1 << 18,
    SEAL_SIZE = 64, // bytes: a line of text with fields of fixed width
};

ty_status ty_file_hash(const char* path, uint64_t size, ty_hasher* hasher, ty_error* error)
{
    FILE* file = fopen(path, "rb");
    if (!file)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot read: %s", strerror(errno));
    uint8_t* buffer = TY_ALLOC(uint8_t, CHUNK);
    errno = 0;
    while (size > 0)
    {
        size_t got = fread(buffer, 1, size < CHUNK ? (size_t)size : CHUNK, file);
        if (got == 0)
            break;
        ty_hasher_add(hasher, buffer, got);
        size -= got;
    }
    int failed = ferror(file) ? (errno ? errno : EIO) : 0;
    ty_free(buffer);
    fclose(file);
    return failed ? ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot read: %s", strerror(failed)) : TY_OK;
}

// The seal of the first bytes of a file.
static ty_status make_seal(const char* path, uint64_t size, char seal[SEAL_SIZE + 1], ty_error* error)
{
    char hex[33];
    ty_hasher* hasher = ty_hasher_create();
    ty_status status = ty_file_hash(path, size, hasher, error);
    ty_hash_hex(ty_hasher_end(hasher), hex);
    snprintf(seal, SEAL_SIZE + 1, "tsuya texture %016" PRIx64 "%s\n", size, hex);
    TY_ASSERT(strlen(seal) == SEAL_SIZE - 1);
    return status;
}

static bool size_of(const char* path, uint64_t* size)
{
    struct stat info;
    bool good = stat(path, &info) == 0 && info.st_size >= 0;
    *size = good ? (uint64_t)info.st_size : 0;
    return good;
}

ty_status ty_mip_seal(const char* path, ty_error* error)
{
    char seal[SEAL_SIZE + 1] = "";
    uint64_t size;
    if (!size_of(path, &size))
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot read: %s", strerror(errno));
    ty_status status = make_seal(path, size, seal, error);
    if (status)
        return status;
    int fd = open(path, O_WRONLY | O_APPEND | O_CLOEXEC);
    bool good = fd >= 0 && ty_descriptor_write(fd, seal, SEAL_SIZE);
    int failed = errno;
    if (fd >= 0 && close(fd) != 0 && good)
    {
        good = false;
        failed = errno;
    }
    return good ? TY_OK
                : ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot keep the converted texture: %s",
                                  strerror(failed));
}

bool ty_mip_is_sealed(const char* path)
{
    char seal[SEAL_SIZE + 1] = "", expected[SEAL_SIZE + 1];
    uint64_t size;
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    bool good = fd >= 0 && size_of(path, &size) && size > SEAL_SIZE &&
                pread(fd, seal, SEAL_SIZE, (off_t)(size - SEAL_SIZE)) == SEAL_SIZE;
    if (fd >= 0)
        close(fd);
    return good && make_seal(path, size - SEAL_SIZE, expected, NULL) == TY_OK && memcmp(seal, expected, SEAL_SIZE) == 0;
}
