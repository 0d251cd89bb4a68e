// SPDX-License-Identifier: Apache-2.0
// Outputs that are complete or absent: a temporary beside the target, fsync, rename, fsync of the folder.
#include "file_pending.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <tsuya/base/file.h>
#include <unistd.h>

enum
{
    temporary_attempts = 1000
};

static atomic_uint temporary_counter;

static ty_status fail_errno(ty_error* error, const char* path, const char* what)
{
    return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "%s: %s", what, strerror(errno));
}

// Follows a link, so that the file it names is replaced and not the link, and refuses what cannot be replaced.
static ty_status target_resolve(ty_atomic_file* file, const char* path, ty_error* error)
{
    size_t length = strlen(path);
    if (length == 0 || length >= sizeof(file->path))
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot write: the path is %s",
                               length ? "too long" : "empty");
    memcpy(file->path, path, length + 1);
    struct stat info;
    if (lstat(path, &info) != 0)
        return errno == ENOENT && path[length - 1] != '/' ? TY_OK : fail_errno(error, path, "cannot write");
    if (S_ISLNK(info.st_mode))
    {
        char resolved[PATH_MAX];
        if (stat(path, &info) != 0 || (S_ISREG(info.st_mode) && !realpath(path, resolved)))
            return fail_errno(error, path, "cannot write through the link");
        if (S_ISREG(info.st_mode))
            snprintf(file->path, sizeof(file->path), "%s", resolved);
    }
    if (S_ISDIR(info.st_mode))
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot write: it is a folder");
    if (!S_ISREG(info.st_mode))
        return ty_error_set_at(
            error, TY_BAD_FILE, path, 0, 0,
            "cannot write: it exists and is not a regular file, so it cannot be replaced in one step");
    if (access(file->path, W_OK) != 0)
        return fail_errno(error, path, "cannot write");
    return TY_OK;
}

// folder/.NAME.tmp-PID-COUNTER.EXTENSION, NAME cut to what a file system allows.
static bool temporary_name(ty_atomic_file* file)
{
    char folder[TY_PATH_MAX], name[NAME_MAX + 1];
    ty_path_folder(file->path, folder);
    const char* slash = strrchr(file->path, '/');
    const char* target = slash ? slash + 1 : file->path;
    const char* extension = ty_path_extension(target);
    int size = snprintf(name, sizeof(name), ".%.100s.tmp-%ld-%u%s%s", target, (long)getpid(),
                        atomic_fetch_add(&temporary_counter, 1), extension[0] ? "." : "", extension);
    if (size < 0 || size >= (int)sizeof(name))
        return false;
    ty_path_join(slash ? folder : "", name, file->temporary);
    return file->temporary[0] != 0;
}

// Creates the temporary under a name that nobody has.
static ty_status temporary_create(ty_atomic_file* file, ty_error* error)
{
    for (int i = 0; i < temporary_attempts; i++)
    {
        if (!temporary_name(file))
            return ty_error_set_at(error, TY_BAD_FILE, file->path, 0, 0, "cannot write: the path is too long");
        file->slot = pending_add(file->temporary);
        if (file->slot < 0)
            return ty_error_set_at(error, TY_BAD_FILE, file->path, 0, 0,
                                   "cannot write: too many outputs are open already");
        int fd = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0)
        {
            close(fd);
            return TY_OK;
        }
        pending_drop(file->slot);
        file->slot = -1;
        if (errno != EEXIST)
            break;
    }
    return fail_errno(error, file->path, "cannot write");
}

ty_status ty_atomic_begin(ty_atomic_file* file, const char* path, ty_error* error)
{
    memset(file, 0, sizeof(*file));
    file->slot = -1;
    ty_status status = target_resolve(file, path, error);
    return status ? status : temporary_create(file, error);
}

// What the system has only promised so far (a full disk, a quota) comes out here.
static bool path_sync(const char* path, int flags)
{
    int fd = open(path, O_RDONLY | O_CLOEXEC | flags);
    if (fd < 0)
        return false;
    bool done = fsync(fd) == 0;
    int saved = errno;
    close(fd);
    errno = saved;
    return done;
}

ty_status ty_atomic_commit(ty_atomic_file* file, ty_error* error)
{
    TY_ASSERT(file->slot >= 0);
    if (!path_sync(file->temporary, 0) || rename(file->temporary, file->path) != 0)
    {
        ty_status status = fail_errno(error, file->path, "cannot write");
        ty_atomic_abort(file);
        return status;
    }
    pending_drop(file->slot);
    file->slot = -1;
    char folder[TY_PATH_MAX];
    ty_path_folder(file->path, folder);
    // Some file systems cannot sync a folder, and one may write to a folder without reading it: only a lost disk
    // counts.
    if (!path_sync(folder, O_DIRECTORY) && errno == EIO)
        return fail_errno(error, file->path, "cannot write its folder");
    return TY_OK;
}

void ty_atomic_abort(ty_atomic_file* file)
{
    if (file->slot < 0)
        return;
    unlink(file->temporary);
    pending_drop(file->slot);
    file->slot = -1;
}

bool ty_descriptor_write(int fd, const void* bytes, size_t size)
{
    const char* next = bytes;
    while (size > 0)
    {
        ssize_t written = write(fd, next, size);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return false;
        next += written;
        size -= (size_t)written;
    }
    return true;
}

ty_status ty_file_write(const char* path, const void* bytes, size_t size, ty_error* error)
{
    ty_atomic_file file;
    ty_status status = ty_atomic_begin(&file, path, error);
    if (status)
        return status;
    int fd = open(file.temporary, O_WRONLY | O_CLOEXEC);
    if (fd < 0 || !ty_descriptor_write(fd, bytes, size))
        status = fail_errno(error, path, "cannot write");
    if (fd >= 0 && close(fd) != 0 && !status)
        status = fail_errno(error, path, "cannot write");
    if (status)
        ty_atomic_abort(&file);
    return status ? status : ty_atomic_commit(&file, error);
}
