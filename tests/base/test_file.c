// SPDX-License-Identifier: Apache-2.0
// Reading within bounds, writing all or nothing, folders and paths. Each test works in a folder of its own.
#include "alloc_sweep.h"
#include "cmocka_all.h"
#include "process.h"
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>
#include <unistd.h>

static char folder[64];
static char path[TY_PATH_MAX];

static const char* at(const char* name)
{
    ty_path_join(folder, name, path);
    return path;
}

static int folder_make(void** state)
{
    (void)state;
    snprintf(folder, sizeof(folder), "/tmp/tsuya_file_XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int entries_of(const char* name)
{
    int count = 0;
    DIR* directory = opendir(name);
    for (struct dirent* entry; directory && (entry = readdir(directory));)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    if (directory)
        closedir(directory);
    return count;
}

static int folder_remove(void** state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof(command), "rm -rf '%s'", folder);
    return system(command);
}

static void write_plain(const char* name, const char* text)
{
    FILE* file = fopen(at(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    assert_int_equal(fclose(file), 0);
}

static void assert_content(const char* name, const char* text)
{
    ty_bytes bytes;
    ty_error error;
    if (ty_file_read(at(name), 1000, &bytes, &error))
        fail_msg("%s", error.text);
    assert_int_equal(bytes.size, strlen(text));
    assert_string_equal((char*)bytes.data, text);
    ty_bytes_term(&bytes);
    assert_null(bytes.data);
    size_t size = 0;
    assert_int_equal(ty_file_size(at(name), &size, NULL), TY_OK);
    assert_int_equal(size, strlen(text));
}

static void assert_unreadable(const char* name, size_t max_size, const char* reason)
{
    ty_bytes bytes = {(uint8_t*)&path, 3};
    ty_error error;
    assert_int_equal(ty_file_read(at(name), max_size, &bytes, &error), TY_BAD_FILE);
    assert_null(bytes.data);
    assert_int_equal(bytes.size, 0);
    assert_string_equal(error.file, at(name));
    if (!strstr(error.text, reason))
        fail_msg("'%s' does not say '%s'", error.text, reason);
}

static void test_read(void** state)
{
    (void)state;
    write_plain("a.txt", "grain\n");
    assert_content("a.txt", "grain\n");
    write_plain("empty", "");
    assert_content("empty", "");
    ty_bytes bytes;
    assert_int_equal(ty_file_read(at("a.txt"), 6, &bytes, NULL), TY_OK); // exactly the bound
    ty_bytes_term(&bytes);
    assert_unreadable("a.txt", 5, "6 bytes");
    assert_unreadable("missing", 5, "No such file");
    assert_unreadable(".", 5, "folder");
    assert_int_equal(mkfifo(at("pipe"), 0600), 0);
    assert_unreadable("pipe", 5, "not a regular file"); // and does not wait for a writer
}

static ty_status read_once(void* context)
{
    ty_bytes bytes;
    ty_error error;
    ty_status status = ty_file_read(context, 1000, &bytes, &error);
    ty_bytes_term(&bytes);
    return status;
}

static void test_read_without_memory(void** state)
{
    (void)state;
    write_plain("a.txt", "grain\n");
    assert_int_equal(ty_alloc_sweep(read_once, (void*)(uintptr_t)at("a.txt")), 1);
}

static void test_write_and_replace(void** state)
{
    (void)state;
    ty_error error;
    assert_int_equal(ty_file_write(at("out.txt"), "old", 3, &error), TY_OK);
    assert_content("out.txt", "old");
    assert_int_equal(ty_file_write(at("out.txt"), "newer", 5, &error), TY_OK);
    assert_content("out.txt", "newer");
    assert_int_equal(ty_file_write(at("empty"), NULL, 0, &error), TY_OK);
    assert_content("empty", "");
    assert_int_equal(entries_of(folder), 2);
}

static void test_permissions_follow_the_mask(void** state)
{
    (void)state;
    mode_t before = umask(027);
    struct stat info;
    assert_int_equal(ty_file_write(at("out"), "x", 1, NULL), TY_OK);
    umask(before);
    assert_int_equal(stat(at("out"), &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
}

static void test_temporary_and_commit(void** state)
{
    (void)state;
    write_plain("image.exr", "old");
    ty_atomic_file file;
    ty_error error;
    assert_int_equal(ty_atomic_begin(&file, at("image.exr"), &error), TY_OK);
    assert_string_equal(ty_path_extension(file.temporary), "exr");
    assert_true(ty_file_exists(file.temporary));
    char beside[TY_PATH_MAX];
    ty_path_folder(file.temporary, beside);
    assert_string_equal(beside, folder);
    FILE* out = fopen(file.temporary, "wb");
    fputs("new", out);
    fclose(out);
    assert_content("image.exr", "old"); // until the commit
    assert_int_equal(ty_atomic_commit(&file, &error), TY_OK);
    assert_content("image.exr", "new");
    assert_int_equal(entries_of(folder), 1);
    ty_atomic_abort(&file); // too late, harmless
    assert_content("image.exr", "new");
}

static void test_abort_leaves_the_old(void** state)
{
    (void)state;
    write_plain("image.exr", "old");
    ty_atomic_file file, other;
    assert_int_equal(ty_atomic_begin(&file, at("image.exr"), NULL), TY_OK);
    assert_int_equal(ty_atomic_begin(&other, at("image.exr"), NULL), TY_OK); // two at once do not meet
    assert_string_not_equal(file.temporary, other.temporary);
    ty_atomic_abort(&file);
    assert_int_equal(entries_of(folder), 2);
    ty_atomic_abort(&other);
    assert_content("image.exr", "old");
    assert_int_equal(entries_of(folder), 1);
}

static void put_in(const char* parent, const char* name, const char* text)
{
    char full[TY_PATH_MAX];
    ty_error error;
    ty_path_join(parent, name, full);
    assert_int_equal(ty_file_write(full, text, strlen(text), &error), TY_OK);
}

static void test_abort_all(void** state)
{
    (void)state;
    ty_atomic_file files[3];
    for (int i = 0; i < 3; i++)
        assert_int_equal(ty_atomic_begin(&files[i], at("x.png"), NULL), TY_OK);
    ty_atomic_folder frames;
    assert_int_equal(ty_atomic_folder_begin(&frames, at("frames"), NULL), TY_OK);
    for (int i = 0; i < 300; i++) // more than a list of them takes at once
    {
        char name[100];
        snprintf(name, sizeof name, "%080d", i);
        put_in(frames.temporary, name, "one");
    }
    assert_int_equal(entries_of(folder), 4);
    ty_atomic_abort_all();
    assert_int_equal(entries_of(folder), 0);
    ty_error error;
    assert_int_equal(ty_atomic_commit(&files[0], &error), TY_BAD_FILE); // what is gone cannot be committed
    assert_false(ty_file_exists(at("x.png")));
    ty_atomic_abort(&files[1]);
    ty_atomic_abort(&files[2]);
    ty_atomic_folder_abort(&frames);
}

static void abort_all_in_child(void* context)
{
    (void)context;
    ty_atomic_abort_all();
}

static void test_child_leaves_our_files(void** state)
{
    (void)state;
    ty_atomic_file file;
    assert_int_equal(ty_atomic_begin(&file, at("x.png"), NULL), TY_OK);
    process_run(abort_all_in_child, NULL);
    assert_true(ty_file_exists(file.temporary));
    ty_atomic_abort(&file);
}

static void test_slots_are_given_back(void** state)
{
    (void)state;
    ty_atomic_file file;
    for (int i = 0; i < 300; i++)
    {
        assert_int_equal(ty_atomic_begin(&file, at("x.png"), NULL), TY_OK);
        if (i % 2)
            ty_atomic_abort(&file);
        else
            assert_int_equal(ty_atomic_commit(&file, NULL), TY_OK);
        assert_int_not_equal(ty_atomic_begin(&file, at("no/such/x.png"), NULL), TY_OK);
    }
    ty_atomic_file* many = TY_ALLOC(ty_atomic_file, 65);
    for (int i = 0; i < 64; i++)
        assert_int_equal(ty_atomic_begin(&many[i], at("x.png"), NULL), TY_OK);
    assert_int_equal(ty_atomic_begin(&many[64], at("x.png"), NULL), TY_BAD_FILE);
    for (int i = 0; i < 65; i++)
        ty_atomic_abort(&many[i]);
    ty_free(many);
    assert_int_equal(entries_of(folder), 1);
}

static void assert_unwritable(const char* target, const char* reason)
{
    ty_error error;
    int before = entries_of(folder);
    assert_int_equal(ty_file_write(target, "x", 1, &error), TY_BAD_FILE);
    if (!strstr(error.text, reason))
        fail_msg("'%s' does not say '%s'", error.text, reason);
    assert_string_equal(error.file, target);
    assert_int_equal(entries_of(folder), before);
}

static void test_unwritable_targets(void** state)
{
    (void)state;
    // A pipe of our own stands for the devices: a broken check must not cost the machine its /dev/null.
    assert_int_equal(mkfifo(at("pipe"), 0600), 0);
    assert_unwritable(at("pipe"), "not a regular file");
    assert_int_equal(symlink("pipe", at("link")), 0);
    assert_unwritable(at("link"), "not a regular file");
    assert_unwritable(at("missing/out.exr"), "No such file");
    assert_int_equal(mkdir(at("sub"), 0777), 0);
    assert_unwritable(at("sub"), "folder");
    assert_unwritable(at("new/"), "");
    assert_unwritable("", "empty");
    write_plain("plain", "x");
    assert_unwritable(at("plain/out.exr"), "Not a directory");
    char large[TY_PATH_MAX + 100];
    memset(large, 'a', sizeof(large) - 1);
    large[sizeof(large) - 1] = 0;
    ty_error error;
    assert_int_equal(ty_file_write(large, "x", 1, &error), TY_BAD_FILE);
    assert_non_null(strstr(error.text, "too long"));
}

static void write_to_stdout(void* context)
{
    int* ends = context;
    dup2(ends[1], STDOUT_FILENO);
    ty_error error;
    ty_status status = ty_file_write(at("stdout"), "x", 1, &error);
    _exit(status == TY_BAD_FILE && strstr(error.text, "not a regular file") ? 0 : 1);
}

static void test_stdout_is_not_replaced(void** state)
{
    (void)state;
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(symlink("/proc/self/fd/1", at("stdout")), 0); // as /dev/stdout is
    assert_int_equal(process_run(write_to_stdout, ends).exit_status, 0);
    close(ends[0]);
    close(ends[1]);
    struct stat info;
    assert_int_equal(lstat(at("stdout"), &info), 0);
    assert_true(S_ISLNK(info.st_mode));
}

static void test_links_are_followed(void** state)
{
    (void)state;
    write_plain("real", "old");
    assert_int_equal(symlink("real", at("link")), 0);
    assert_int_equal(ty_file_write(at("link"), "new", 3, NULL), TY_OK);
    assert_content("real", "new");
    struct stat info;
    assert_int_equal(lstat(at("link"), &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(symlink("nowhere", at("dangling")), 0);
    assert_unwritable(at("dangling"), "link");
}

static void test_longest_name(void** state)
{
    (void)state;
    char name[256];
    memset(name, 'n', 251);
    memcpy(name + 251, ".exr", 5);
    assert_int_equal(ty_file_write(at(name), "x", 1, NULL), TY_OK); // the temporary's name is cut
    assert_content(name, "x");
}

static void write_over_limit(void* context)
{
    signal(SIGXFSZ, SIG_IGN);
    struct rlimit limit = {10000, 10000};
    setrlimit(RLIMIT_FSIZE, &limit);
    static char bytes[20000];
    ty_error error;
    ty_status status = ty_file_write(context, bytes, sizeof(bytes), &error);
    _exit(status == TY_BAD_FILE && strstr(error.text, "File too large") ? 0 : 1);
}

// A disk that fills up, in small: the old file stays, no temporary does.
static void test_failed_write_leaves_the_old(void** state)
{
    (void)state;
    write_plain("out", "old");
    assert_int_equal(process_run(write_over_limit, (void*)(uintptr_t)at("out")).exit_status, 0);
    assert_content("out", "old");
    assert_int_equal(entries_of(folder), 1);
}

static void test_folder_create(void** state)
{
    (void)state;
    ty_error error;
    assert_int_equal(ty_folder_create(at("a/b//c/"), &error), TY_OK);
    assert_true(ty_folder_exists(at("a/b/c")));
    assert_int_equal(ty_folder_create(at("a/b"), &error), TY_OK);
    assert_false(ty_file_exists(at("a/b")));
    write_plain("plain", "x");
    assert_int_equal(ty_folder_create(at("plain"), &error), TY_BAD_FILE);
    assert_int_equal(ty_folder_create(at("plain/sub"), &error), TY_BAD_FILE);
    assert_int_equal(ty_folder_create("", &error), TY_BAD_FILE);
    assert_false(ty_folder_exists(at("plain")));
    assert_true(ty_file_exists(at("plain")));
}

static void assert_folder(const char* of, const char* expected)
{
    char out[TY_PATH_MAX];
    ty_path_folder(of, out);
    assert_string_equal(out, expected);
}

static void test_paths(void** state)
{
    (void)state;
    assert_string_equal(ty_path_extension("a/b.c/image.0001.exr"), "exr");
    assert_string_equal(ty_path_extension("a.b/name"), "");
    assert_string_equal(ty_path_extension("/x/.hidden"), "");
    assert_string_equal(ty_path_extension("name."), "");
    assert_folder("a/b/c.exr", "a/b");
    assert_folder("c.exr", ".");
    assert_folder("/c.exr", "/");
    char out[TY_PATH_MAX];
    ty_path_join("a", "b", out);
    assert_string_equal(out, "a/b");
    ty_path_join("a/", "b", out);
    assert_string_equal(out, "a/b");
    ty_path_join("a", "/b", out);
    assert_string_equal(out, "/b");
    ty_path_join("", "b", out);
    assert_string_equal(out, "b");
    char large[TY_PATH_MAX];
    memset(large, 'a', sizeof(large) - 1);
    large[sizeof(large) - 1] = 0;
    ty_path_join(large, "b", out); // cut short it would name another file
    assert_string_equal(out, "");
}

static void touch_at(const char* name, time_t seconds)
{
    write_plain(name, "0123456789");
    const struct timespec times[2] = {{seconds, 0}, {seconds, 0}};
    assert_int_equal(utimensat(AT_FDCWD, at(name), times, 0), 0);
}

static void test_trim(void** state)
{
    (void)state;
    char whole[TY_PATH_MAX];
    touch_at("c.kept", 3000);
    touch_at("a.kept", 4000);
    touch_at("b.kept", 1000);
    touch_at("d.kept", 2000);
    touch_at("old.ply", 500);
    touch_at(".b.kept", 100); // somebody writes it
    assert_int_equal(mkdir(at("folder.kept"), 0777), 0);
    ty_folder_trim(folder, "kept", 40);
    assert_int_equal(entries_of(folder), 7);
    ty_file_touch(at("b.kept")); // used just now
    ty_folder_trim(folder, "kept", 29);
    assert_int_equal(entries_of(folder), 5);
    assert_true(ty_file_exists(at("a.kept")) && ty_file_exists(at("b.kept")));
    assert_true(ty_file_exists(at("old.ply")) && ty_folder_exists(at("folder.kept")));
    ty_folder_trim(folder, "kept", 0);
    assert_int_equal(entries_of(folder), 3);
    snprintf(whole, sizeof whole, "%s", at("nowhere"));
    ty_folder_trim(whole, "kept", 0);
    ty_file_touch(whole);
    assert_false(ty_file_exists(whole));
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, folder_make, folder_remove)

static void assert_frame(const char* pattern, int frame, const char* expected)
{
    char out[TY_PATH_MAX];
    ty_path_frame(pattern, frame, out);
    assert_string_equal(out, expected);
}

static void test_sequences(void** state)
{
    (void)state;
    assert_true(ty_path_is_sequence("a/fill.####.exr"));
    assert_true(ty_path_is_sequence("#"));
    assert_false(ty_path_is_sequence("a##/fill.exr")); // a folder's name is a name
    assert_frame("a#/fill.####.exr", 7, "a#/fill.0007.exr");
    assert_frame("fill.##.exr", 12345, "fill.12345.exr");
    assert_frame("fill.####.exr", -7, "fill.-007.exr");
    assert_frame("take#2_##", 5, "take#2_05");
    assert_frame("a##/fill.exr", 5, "a##/fill.exr");
    char most[TY_PATH_MAX];
    memset(most, 'x', sizeof(most));
    memcpy(most, "#", 1);
    most[TY_PATH_MAX - 1] = 0;
    assert_frame(most, 100, ""); // does not fit: names nothing
}

static void test_folders_are_whole(void** state)
{
    (void)state;
    ty_atomic_folder frames;
    ty_error error;
    char target[TY_PATH_MAX];
    strcpy(target, at("frames"));
    assert_int_equal(ty_atomic_folder_begin(&frames, target, &error), TY_OK);
    put_in(frames.temporary, "1", "one");
    assert_false(ty_folder_exists(target));
    assert_int_equal(ty_atomic_folder_commit(&frames, &error), TY_OK);
    assert_content("frames/1", "one");
    ty_atomic_folder_abort(&frames); // harmless
    assert_content("frames/1", "one");
    // another takes its place, files and all
    assert_int_equal(ty_atomic_folder_begin(&frames, target, &error), TY_OK);
    put_in(frames.temporary, "2", "two");
    assert_int_equal(ty_atomic_folder_commit(&frames, &error), TY_OK);
    assert_content("frames/2", "two");
    assert_int_equal(entries_of(target), 1);
    // given up: what is there stays
    assert_int_equal(ty_atomic_folder_begin(&frames, target, &error), TY_OK);
    put_in(frames.temporary, "3", "three");
    ty_atomic_folder_abort(&frames);
    assert_int_equal(entries_of(target), 1);
    assert_int_equal(entries_of(folder), 1);
    char link[TY_PATH_MAX];
    strcpy(link, at("link"));
    assert_int_equal(symlink(target, link), 0);
    ty_folder_remove(link); // a link is no folder of ours
    assert_content("frames/2", "two");
    assert_int_equal(unlink(link), 0);
    write_plain("file", "text"); // is in the way
    assert_int_equal(ty_atomic_folder_begin(&frames, at("file"), &error), TY_OK);
    assert_int_equal(ty_atomic_folder_commit(&frames, &error), TY_BAD_FILE);
    assert_content("file", "text");
    assert_int_equal(entries_of(folder), 2);
    assert_int_equal(ty_atomic_folder_begin(&frames, at("no/such"), &error), TY_BAD_FILE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_read),
        IN_FOLDER(test_read_without_memory),
        IN_FOLDER(test_write_and_replace),
        IN_FOLDER(test_permissions_follow_the_mask),
        IN_FOLDER(test_temporary_and_commit),
        IN_FOLDER(test_abort_leaves_the_old),
        IN_FOLDER(test_abort_all),
        IN_FOLDER(test_child_leaves_our_files),
        IN_FOLDER(test_slots_are_given_back),
        IN_FOLDER(test_unwritable_targets),
        IN_FOLDER(test_stdout_is_not_replaced),
        IN_FOLDER(test_links_are_followed),
        IN_FOLDER(test_longest_name),
        IN_FOLDER(test_failed_write_leaves_the_old),
        IN_FOLDER(test_folder_create),
        IN_FOLDER(test_folders_are_whole),
        IN_FOLDER(test_trim),
        cmocka_unit_test(test_paths),
        cmocka_unit_test(test_sequences),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
