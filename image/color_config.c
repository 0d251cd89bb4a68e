// SPDX-License-Identifier: Apache-2.0
// The embedded OpenColorIO configuration, made of OpenColorIO's built-in transforms. The reference space is ACES2065-1,
// displays are reached through CIE XYZ (D65). ACES 1.0 SDR is the ACES 1.x output transform for SDR video.
#include "color_config.h"

#define AP1_TO_REFERENCE "!<BuiltinTransform> {style: ACEScg_to_ACES2065-1}"
#define REC709_TO_AP1 "!<BuiltinTransform> {style: UTILITY - ACES-AP1_to_LINEAR-REC709_BFD, direction: inverse}"

// A texture space: its curve to linear Rec.709, then to the reference.
#define TEXTURE_SPACE(name, aliases, about, curve)                                                                     \
    "  - !<ColorSpace>\n"                                                                                              \
    "    name: " name "\n"                                                                                             \
    "    aliases: [" aliases "]\n"                                                                                     \
    "    family: Texture\n"                                                                                            \
    "    description: " about "\n"                                                                                     \
    "    isdata: false\n"                                                                                              \
    "    to_scene_reference: !<GroupTransform>\n"                                                                      \
    "      children:\n"                                                                                                \
    "        - " curve "\n"                                                                                            \
    "        - " REC709_TO_AP1 "\n"                                                                                    \
    "        - " AP1_TO_REFERENCE "\n"

#define DISPLAY_SPACE(name, about, style)                                                                              \
    "  - !<ColorSpace>\n"                                                                                              \
    "    name: " name "\n"                                                                                             \
    "    family: Display\n"                                                                                            \
    "    description: " about "\n"                                                                                     \
    "    isdata: false\n"                                                                                              \
    "    from_display_reference: !<BuiltinTransform> {style: " style "}\n"

#define DISPLAY(name, space)                                                                                           \
    "  " name ":\n"                                                                                                    \
    "    - !<View> {name: ACES 1.0 SDR, view_transform: ACES 1.0 SDR, display_colorspace: " space "}\n"                \
    "    - !<View> {name: Untonemapped, view_transform: Untonemapped, display_colorspace: " space "}\n"                \
    "    - !<View> {name: Raw, colorspace: raw}\n"

const char ty_color_embedded_config[] =
    "ocio_profile_version: 2\n"
    "search_path: \"\"\n"
    "strictparsing: true\n"
    "luma: [0.2126, 0.7152, 0.0722]\n"
    "name: tsuya\n"
    "roles:\n"
    "  aces_interchange: ACES2065-1\n"
    "  cie_xyz_d65_interchange: CIE-XYZ-D65\n"
    "  color_picking: srgb_texture\n"
    "  data: raw\n"
    "  default: raw\n"
    "  matte_paint: srgb_texture\n"
    "  rendering: ACEScg\n"
    "  scene_linear: ACEScg\n"
    "  texture_paint: srgb_texture\n"
    "file_rules:\n"
    "  - !<Rule> {name: Default, colorspace: default}\n"
    "displays:\n" DISPLAY("sRGB", "sRGB - Display") DISPLAY("Rec.1886", "Rec.1886 - Display") //
    "active_displays: [sRGB, Rec.1886]\n"
    "active_views: [ACES 1.0 SDR, Untonemapped, Raw]\n"
    "default_view_transform: Untonemapped\n"
    "view_transforms:\n"
    "  - !<ViewTransform>\n"
    "    name: ACES 1.0 SDR\n"
    "    from_scene_reference: !<BuiltinTransform> {style: ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0}\n"
    "  - !<ViewTransform>\n"
    "    name: Untonemapped\n"
    "    from_scene_reference: !<BuiltinTransform> {style: UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD}\n"
    "display_colorspaces:\n"
    "  - !<ColorSpace>\n"
    "    name: CIE-XYZ-D65\n"
    "    family: Display\n"
    "    description: CIE XYZ, D65 white\n"
    "    isdata: false\n" //
    DISPLAY_SPACE("sRGB - Display", "sRGB monitor", "DISPLAY - CIE-XYZ-D65_to_sRGB")
        DISPLAY_SPACE("Rec.1886 - Display", "Rec.709 primaries with the curve of BT.1886",
                      "DISPLAY - CIE-XYZ-D65_to_REC.1886-REC.709") //
    "colorspaces:\n"
    "  - !<ColorSpace>\n"
    "    name: ACES2065-1\n"
    "    aliases: [aces2065_1, lin_ap0]\n"
    "    family: ACES\n"
    "    description: ACES interchange, AP0 primaries, linear\n"
    "    isdata: false\n"
    "  - !<ColorSpace>\n"
    "    name: ACEScg\n"
    "    aliases: [lin_ap1, ACES - ACEScg]\n"
    "    family: ACES\n"
    "    description: The rendering space, AP1 primaries, linear\n"
    "    isdata: false\n"
    "    to_scene_reference: " AP1_TO_REFERENCE "\n"
    "  - !<ColorSpace>\n"
    "    name: lin_rec709\n"
    "    aliases: [linear sRGB, Linear Rec.709 (sRGB), lin_rec709_srgb, lin_srgb, Linear]\n"
    "    family: Linear\n"
    "    description: Rec.709 and sRGB primaries, linear\n"
    "    isdata: false\n"
    "    to_scene_reference: !<GroupTransform>\n"
    "      children:\n"
    "        - " REC709_TO_AP1 "\n"
    "        - " AP1_TO_REFERENCE "\n" //
    TEXTURE_SPACE("srgb_texture", "sRGB, sRGB - Texture, srgb_tx", "sRGB primaries and curve",
                  "!<ExponentWithLinearTransform> {gamma: 2.4, offset: 0.055}")
        TEXTURE_SPACE("rec1886_texture", "Rec.1886, Rec.709, Rec709, Rec.1886 Rec.709 - Texture",
                      "Rec.709 primaries and the curve of BT.1886 (gamma 2.4)", "!<ExponentTransform> {value: 2.4}") //
    "  - !<ColorSpace>\n"
    "    name: raw\n"
    "    aliases: [Utility - Raw]\n"
    "    family: Data\n"
    "    description: Numbers that are no colours\n"
    "    isdata: true\n";
