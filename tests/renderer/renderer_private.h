// SPDX-License-Identifier: Apache-2.0
// What the renderer's tests reach into: its private headers, and cmocka.
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../../renderer/camera.h"
#include "../../renderer/film.h"
#include "../../renderer/light.h"
#include "../../renderer/pixel_filter.h"
#include "../../renderer/sampler.h"
