// SPDX-License-Identifier: Apache-2.0
// Bounded reading, folders and paths.
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>
#include <unistd.h>

void ty_bytes_term(ty_bytes* bytes)
{
    ty_free(bytes->data);
    *bytes = (ty_bytes){0};
}

static ty_status fail_errno(ty_error* error, const char* path, const char* what)
{
    return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "%s: %s", what, strerror(errno));
}

// Reads up to size bytes; fewer when the file has become shorter.
static ty_status descriptor_read(int fd, const char* path, ty_bytes* bytes, size_t size, ty_error* error)
{
    while (bytes->size < size)
    {
        ssize_t count = read(fd, bytes->data + bytes->size, size - bytes->size);
        if (count < 0 && errno == EINTR)
            continue;
        if (count < 0)
            return fail_errno(error, path, "cannot read");
        if (count == 0)
            break;
        bytes->size += (size_t)count;
    }
    return TY_OK;
}

static ty_status open_size(int fd, const char* path, size_t* out, ty_error* error)
{
    struct stat info;
    if (fstat(fd, &info) != 0)
        return fail_errno(error, path, "cannot read");
    if (S_ISDIR(info.st_mode))
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "is a folder, not a file");
    if (!S_ISREG(info.st_mode))
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "is not a regular file");
    *out = (size_t)info.st_size;
    return TY_OK;
}

static ty_status open_read(int fd, const char* path, size_t max_size, ty_bytes* out, ty_error* error)
{
    size_t size;
    ty_status status = open_size(fd, path, &size, error);
    if (status != TY_OK)
        return status;
    if (size > max_size)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "has %zu bytes; at most %zu are read", size, max_size);
    ty_bytes bytes = {ty_try_alloc(size + 1, 1), 0};
    if (!bytes.data)
        return ty_error_set_at(error, TY_NO_MEMORY, path, 0, 0, "no memory for its %zu bytes", size);
    status = descriptor_read(fd, path, &bytes, size, error);
    if (status)
        ty_bytes_term(&bytes);
    else
        *out = bytes;
    return status;
}

// Without O_NONBLOCK a named pipe would wait for a writer.
static ty_status open_file(const char* path, int* fd, ty_error* error)
{
    *fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    return *fd < 0 ? fail_errno(error, path, "cannot open") : TY_OK;
}

ty_status ty_file_read(const char* path, size_t max_size, ty_bytes* out, ty_error* error)
{
    int fd;
    *out = (ty_bytes){0};
    ty_status status = open_file(path, &fd, error);
    if (status != TY_OK)
        return status;
    status = open_read(fd, path, max_size, out, error);
    close(fd);
    return status;
}

ty_status ty_file_size(const char* path, size_t* out, ty_error* error)
{
    int fd;
    ty_status status = open_file(path, &fd, error);
    if (status != TY_OK)
        return status;
    status = open_size(fd, path, out, error);
    close(fd);
    return status;
}

ty_status ty_folder_create(const char* path, ty_error* error)
{
    char part[TY_PATH_MAX];
    size_t length = strlen(path);
    if (length == 0 || length >= sizeof(part))
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot create the folder: its path is %s",
                               length ? "too long" : "empty");
    memcpy(part, path, length + 1);
    for (size_t i = 1; i <= length; i++)
    {
        if (part[i] != '/' && part[i] != 0)
            continue;
        part[i] = 0;
        if (mkdir(part, 0777) != 0 && !ty_folder_exists(part))
            return fail_errno(error, part, "cannot create the folder");
        part[i] = path[i];
    }
    return TY_OK;
}

bool ty_file_exists(const char* path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}

bool ty_folder_exists(const char* path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

const char* ty_path_extension(const char* path)
{
    const char* slash = strrchr(path, '/');
    const char* name = slash ? slash + 1 : path;
    const char* dot = strrchr(name, '.');
    return dot && dot > name ? dot + 1 : "";
}

void ty_path_folder(const char* path, char out[TY_PATH_MAX])
{
    const char* slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) : 0;
    if (!slash)
        snprintf(out, TY_PATH_MAX, ".");
    else if (length == 0)
        snprintf(out, TY_PATH_MAX, "/");
    else if (length < TY_PATH_MAX)
        snprintf(out, TY_PATH_MAX, "%.*s", (int)length, path);
    else
        out[0] = 0;
}

void ty_path_join(const char* folder, const char* name, char out[TY_PATH_MAX])
{
    size_t length = strlen(folder);
    bool alone = name[0] == '/' || length == 0;
    const char* slash = alone || folder[length - 1] == '/' ? "" : "/";
    int size = snprintf(out, TY_PATH_MAX, "%s%s%s", alone ? "" : folder, slash, name);
    // A path cut short could name another file; an empty one names none.
    if (size < 0 || size >= TY_PATH_MAX)
        out[0] = 0;
}
