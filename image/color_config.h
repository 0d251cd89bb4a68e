// SPDX-License-Identifier: Apache-2.0
// The embedded OpenColorIO configuration.
#pragma once

extern const char ty_color_embedded_config[]; // YAML
