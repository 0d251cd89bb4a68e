// SPDX-License-Identifier: Apache-2.0
// What the shims over OpenImageIO share: its settings for this process, and exceptions turned into results.
#pragma once
#include "image_oiio.h"
#include <cstdio>
#include <exception>
#include <new>
#include <string>

void ty_oiio_set_up(); // once in effect

// The library's messages end in newlines and may hold several lines; ours are one.
void ty_oiio_set_text(char* text, size_t size, const std::string& message);

inline ty_oiio_result ty_oiio_fail(char* text, size_t size, const std::string& message)
{
    ty_oiio_set_text(text, size, message);
    return TY_OIIO_FAILED;
}

template <class Function> ty_oiio_result ty_oiio_guarded(char* text, size_t size, Function function)
{
    try
    {
        return function();
    }
    catch (const std::bad_alloc&)
    {
        return TY_OIIO_NO_MEMORY;
    }
    catch (const std::exception& exception)
    {
        return ty_oiio_fail(text, size, exception.what());
    }
    catch (...)
    {
        return ty_oiio_fail(text, size, "unknown exception");
    }
}
