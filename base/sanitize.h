// SPDX-License-Identifier: Apache-2.0
// Which sanitizer this build runs under, and manual poisoning of memory.
#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TY_ASAN 1
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define TY_ASAN 1
#endif

#ifdef TY_ASAN
#include <sanitizer/asan_interface.h>
#define TY_POISON(address, size) __asan_poison_memory_region(address, size)
#define TY_UNPOISON(address, size) __asan_unpoison_memory_region(address, size)
#else
#define TY_ASAN 0
#define TY_POISON(address, size) ((void)(address), (void)(size))
#define TY_UNPOISON(address, size) ((void)(address), (void)(size))
#endif
