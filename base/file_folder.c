// SPDX-License-Identifier: Apache-2.0
// Folders that become visible only when all their files are there.
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <tsuya/base/file.h>
#include <unistd.h>

enum
{
    ATTEMPTS = 100
};

void ty_folder_remove(const char* path)
{
    int fd = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    DIR* folder = fd < 0 ? NULL : fdopendir(fd);
    if (!folder && fd >= 0)
        close(fd);
    if (!folder)
        return;
    for (struct dirent* entry = readdir(folder); entry; entry = readdir(folder))
        (void)unlinkat(dirfd(folder), entry->d_name, 0); // fails for folders, "." and ".." among them
    closedir(folder);
    (void)rmdir(path);
}

static ty_status fail_errno(ty_error* error, const char* path)
{
    return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot make the folder: %s", strerror(errno));
}

// Under a name that nobody has.
static bool temporary_create(ty_atomic_folder* folder, const char* parent, const char* target)
{
    for (int i = 0; i < ATTEMPTS; i++)
    {
        char name[NAME_MAX + 1];
        snprintf(name, sizeof(name), ".%.100s.tmp-%ld-%d", target, (long)getpid(), i);
        ty_path_join(parent, name, folder->temporary);
        errno = ENAMETOOLONG;
        if (folder->temporary[0] && mkdir(folder->temporary, 0777) == 0)
            return true;
        if (errno != EEXIST)
            return false;
    }
    return false;
}

ty_status ty_atomic_folder_begin(ty_atomic_folder* folder, const char* path, ty_error* error)
{
    char parent[TY_PATH_MAX];
    const char* slash = strrchr(path, '/');
    memset(folder, 0, sizeof(*folder));
    ty_path_folder(path, parent);
    ty_path_join("", path, folder->path);
    errno = ENAMETOOLONG;
    if (folder->path[0] && temporary_create(folder, parent, slash ? slash + 1 : path))
        return TY_OK;
    folder->temporary[0] = 0;
    return fail_errno(error, path);
}

ty_status ty_atomic_folder_commit(ty_atomic_folder* folder, ty_error* error)
{
    TY_ASSERT(folder->temporary[0]);
    bool moved = rename(folder->temporary, folder->path) == 0; // over nothing or an empty folder
    if (!moved && (errno == ENOTEMPTY || errno == EEXIST))
    {
        moved = renameat2(AT_FDCWD, folder->temporary, AT_FDCWD, folder->path, RENAME_EXCHANGE) == 0;
        if (!moved && (errno == EINVAL || errno == ENOSYS)) // a file system that cannot: then not in one step
        {
            ty_folder_remove(folder->path);
            moved = rename(folder->temporary, folder->path) == 0;
        }
    }
    ty_status status = moved ? TY_OK : fail_errno(error, folder->path);
    ty_atomic_folder_abort(folder); // what stood there before has its name now
    return status;
}

void ty_atomic_folder_abort(ty_atomic_folder* folder)
{
    if (folder->temporary[0])
        ty_folder_remove(folder->temporary);
    folder->temporary[0] = 0;
}
