// SPDX-License-Identifier: Apache-2.0
// The table of the module, the only name that leaves it.
#include "oiio_module.h"

__attribute__((visibility("default"))) extern const ty_oiio_module ty_oiio_module_table;

#define MEMBER(name) .name = name,
const ty_oiio_module ty_oiio_module_table = {.version = TSUYA_VERSION, TY_OIIO_FUNCTIONS(MEMBER)};
