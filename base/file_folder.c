// SPDX-License-Identifier: Apache-2.0
// Folders that become visible only when all their files are there, and folders of files that only save time.
#include "file_pending.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>
#include <unistd.h>

enum
{
    ATTEMPTS = 100
};

// Unlinks what a folder lists, and tells whether anything went. Calls to the system alone: a signal's exit path uses
// it.
static bool files_unlink(int fd)
{
    _Alignas(struct dirent64) char list[4096];
    bool gone = false;
    for (ssize_t size; (size = getdents64(fd, list, sizeof list)) > 0;)
        for (ssize_t at = 0; at < size;)
        {
            const struct dirent64* entry = (const void*)(list + at);
            gone |= unlinkat(fd, entry->d_name, 0) == 0; // fails for folders, "." and ".." among them
            at += entry->d_reclen;
        }
    return gone;
}

void ty_folder_remove(const char* path)
{
    int fd = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (fd < 0)
        return;
    // From the start again while anything goes: a list that shrinks as it is read may leave names out, and another
    // thread may still write.
    while (files_unlink(fd) && lseek(fd, 0, SEEK_SET) == 0)
        continue;
    close(fd);
    (void)rmdir(path);
}

// --- files that only save time ---

typedef struct kept_file
{
    char* name;
    struct timespec touched;
    uint64_t size;
} kept_file;

static int longest_untouched(const void* a, const void* b)
{
    const kept_file *x = a, *y = b;
    if (x->touched.tv_sec != y->touched.tv_sec)
        return x->touched.tv_sec < y->touched.tv_sec ? -1 : 1;
    if (x->touched.tv_nsec != y->touched.tv_nsec)
        return x->touched.tv_nsec < y->touched.tv_nsec ? -1 : 1;
    return strcmp(x->name, y->name);
}

static kept_file* kept_list(DIR* folder, const char* extension, int* count)
{
    kept_file* files = NULL;
    int room = 0;
    *count = 0;
    for (const struct dirent* entry; (entry = readdir(folder));)
    {
        struct stat info;
        if (entry->d_name[0] == '.' || strcmp(ty_path_extension(entry->d_name), extension) != 0 ||
            fstatat(dirfd(folder), entry->d_name, &info, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISREG(info.st_mode))
            continue;
        if (*count == room)
        {
            files = ty_grow(files, (size_t)room, (size_t)room + 64, sizeof(kept_file));
            room += 64;
        }
        files[(*count)++] = (kept_file){ty_string_copy(entry->d_name), info.st_mtim, (uint64_t)info.st_size};
    }
    return files;
}

void ty_folder_trim(const char* folder, const char* extension, uint64_t most)
{
    int count;
    uint64_t sum = 0;
    DIR* open_folder = opendir(folder);
    if (!open_folder)
        return;
    kept_file* files = kept_list(open_folder, extension, &count);
    if (count > 0)
        qsort(files, (size_t)count, sizeof *files, longest_untouched);
    for (int i = 0; i < count; i++)
        sum += files[i].size;
    for (int i = 0; i < count; i++)
    {
        if (sum > most && unlinkat(dirfd(open_folder), files[i].name, 0) == 0)
            sum -= files[i].size;
        ty_free(files[i].name);
    }
    ty_free(files);
    closedir(open_folder);
}

void ty_file_touch(const char* path)
{
    (void)utimensat(AT_FDCWD, path, NULL, 0);
}

// --- folders that are complete or absent ---

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
        if (!folder->temporary[0])
            return false;
        folder->slot = pending_add(folder->temporary); // beyond what the table holds, only a signal leaves it
        if (mkdir(folder->temporary, 0777) == 0)
            return true;
        pending_drop(folder->slot);
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
    if (!folder->temporary[0])
        return;
    ty_folder_remove(folder->temporary);
    pending_drop(folder->slot);
    folder->temporary[0] = 0;
}
