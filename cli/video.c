// SPDX-License-Identifier: Apache-2.0
// The pictures go to ffmpeg through a pipe: no shell, no list of names, no temporary of ours.
#include "video.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/workers.h>
#include <unistd.h>

enum
{
    MOST_PICTURE = 1 << 30, // bytes
    MOST_ARGUMENTS = 48
};

// The first executable `ffmpeg` of PATH; an empty entry is the present folder and left out.
static bool find_ffmpeg(char out[TY_PATH_MAX])
{
    const char* path = getenv("PATH");
    while (path && *path)
    {
        size_t length = strcspn(path, ":");
        snprintf(out, TY_PATH_MAX, "%.*s/ffmpeg", (int)length, path);
        if (length > 0 && length < TY_PATH_MAX - 8 && ty_file_exists(out) && access(out, X_OK) == 0)
        {
            return true;
        }
        path += length + (path[length] == ':');
    }
    return false;
}

bool ty_video_available(void)
{
    char path[TY_PATH_MAX];
    return find_ffmpeg(path);
}

bool ty_video_is_named(const char* output)
{
    static const char* const kinds[] = {"mp4", "mov", "mkv", "gif"};
    for (int i = 0; i < TY_PARAM_COUNT(kinds); i++)
        if (strcmp(ty_path_extension(output), kinds[i]) == 0)
            return true;
    return false;
}

ty_status ty_video_probe(const char* output, ty_error* error)
{
    if (ty_video_is_named(output))
        return ty_output_probe(output, error);
    return ty_error_set(error, TY_USAGE, "the video '%.300s' must end in .mp4, .mov, .mkv or .gif", output);
}

// Sides of yuv420p are even; the colours of the pictures are sRGB, whose primaries are those of BT.709.
static const char* const h264[] = {"-vf",
                                   "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,"
                                   "format=yuv420p",
                                   "-c:v",
                                   "libx264",
                                   "-crf",
                                   "16",
                                   "-preset",
                                   "slow",
                                   "-colorspace",
                                   "bt709",
                                   "-color_primaries",
                                   "bt709",
                                   "-color_trc",
                                   "iec61966-2-1",
                                   "-color_range",
                                   "tv",
                                   "-movflags",
                                   "+faststart",
                                   NULL};
// One palette for all pictures; plays for ever.
static const char* const gif[] = {"-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=none", "-loop", "0",
                                  NULL};

// An ffmpeg that reads pictures from *input (to be closed by the caller) and writes to file.
static ty_status start(const char* ffmpeg, const char* file, double fps, pid_t* child, int* input, ty_error* error)
{
    char rate[32], output[TY_PATH_MAX + 8];
    snprintf(rate, sizeof rate, "%.6g", fps);
    snprintf(output, sizeof output, "file:%s", file); // whatever the name looks like, it is a file
    const char* const input_arguments[] = {"ffmpeg",     "-nostdin", "-hide_banner", "-loglevel", "error",
                                           "-y",         "-f",       "image2pipe",   "-c:v",      "png",
                                           "-framerate", rate,       "-i",           "pipe:0"};
    const char* arguments[MOST_ARGUMENTS] = {NULL};
    int count = 0;
    for (int i = 0; i < TY_PARAM_COUNT(input_arguments); i++)
        arguments[count++] = input_arguments[i];
    const char* const* encoding = strcmp(ty_path_extension(file), "gif") == 0 ? gif : h264;
    for (int i = 0; encoding[i]; i++)
        arguments[count++] = encoding[i];
    arguments[count] = output;
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
    {
        return ty_error_set(error, TY_BAD_FILE, "no pipe to ffmpeg: %s", strerror(errno));
    }
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t defaults;
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGPIPE);
    sigaddset(&defaults, SIGXFSZ);
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0); // results are ours
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    int failed = posix_spawn(child, ffmpeg, &actions, &attributes, (char* const*)arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    *input = ends[1];
    if (failed)
    {
        close(ends[1]);
        return ty_error_set(error, TY_BAD_FILE, "cannot start '%s': %s", ffmpeg, strerror(failed));
    }
    return TY_OK;
}

static ty_status send_pictures(int fd, const char* pattern, const ty_frame_list* list, ty_error* error)
{
    for (int i = 0; i < list->count; i++)
    {
        char path[TY_PATH_MAX];
        ty_bytes bytes;
        if (ty_cancel_requested())
        {
            return ty_error_set(error, ty_cancel_signal() == SIGTERM ? TY_TERMINATED : TY_INTERRUPTED,
                                "stopped before the video was complete");
        }
        ty_path_frame(pattern, list->frames[i], path);
        ty_status status = ty_file_read(path, MOST_PICTURE, &bytes, error);
        if (status != TY_OK)
        {
            return status;
        }
        bool sent = ty_descriptor_write(fd, bytes.data, bytes.size);
        ty_bytes_term(&bytes);
        if (!sent)
        {
            return ty_error_set(error, TY_BAD_FILE, "ffmpeg ended before the last picture");
        }
    }
    return TY_OK;
}

// Waits for its end. Complaints are on standard error already.
static ty_status finish(pid_t child, const char* output, ty_error* error)
{
    int state = 0;
    while (waitpid(child, &state, 0) < 0 && errno == EINTR)
    {
    }
    if (WIFEXITED(state) && WEXITSTATUS(state) == 0)
    {
        return TY_OK;
    }
    int number = WIFSIGNALED(state) ? WTERMSIG(state) : WEXITSTATUS(state);
    return ty_error_set(error, TY_BAD_FILE, "ffmpeg could not make '%.300s' (%s %d)", output,
                        WIFSIGNALED(state) ? "signal" : "status", number);
}

ty_status ty_video_write(const char* output, const char* pattern, const ty_frame_list* list, double fps,
                         ty_error* error)
{
    char ffmpeg[TY_PATH_MAX];
    ty_atomic_file file;
    pid_t child = 0;
    int input = -1;
    if (!find_ffmpeg(ffmpeg))
    {
        return ty_error_set(error, TY_BAD_FILE, "there is no ffmpeg in PATH");
    }
    ty_status status = ty_atomic_begin(&file, output, error);
    if (status != TY_OK)
    {
        return status;
    }
    status = start(ffmpeg, file.temporary, fps, &child, &input, error);
    if (status == TY_OK)
    {
        status = send_pictures(input, pattern, list, error);
        close(input);
        bool stopped = status == TY_INTERRUPTED || status == TY_TERMINATED;
        if (stopped)
        {
            kill(child, SIGTERM);
        }
        ty_error ending;
        ty_status ended = finish(child, output, &ending);
        if (!stopped && ended != TY_OK) // its own failure explains ours
        {
            status = ended;
            *error = ending;
        }
    }
    if (status != TY_OK)
    {
        ty_atomic_abort(&file);
        return status;
    }
    return ty_atomic_commit(&file, error);
}
