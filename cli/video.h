// SPDX-License-Identifier: Apache-2.0
// Developed frames to a video, by the ffmpeg of the machine.
#pragma once
#include "frames.h"

// Whether there is an ffmpeg in PATH.
bool ty_video_available(void);
// Whether the name ends as that of a video: .mp4, .mov, .mkv or .gif.
bool ty_video_is_named(const char* output);
// Checks the name, and that it is in a folder that can be written.
TY_CHECKED ty_status ty_video_probe(const char* output, ty_error* error);
// The pictures of pattern at the list's frames, in order, `fps` a second: H.264, yuv420p, BT.709; or a GIF that plays
// for ever. The file is complete or absent. TY_INTERRUPTED or TY_TERMINATED on a cancel request.
TY_CHECKED ty_status ty_video_write(const char* output, const char* pattern, const ty_frame_list* list, double fps,
                                    ty_error* error);

// film.c: as ty_output_check of an output; one that is named as a film is one file and needs an ffmpeg.
TY_CHECKED ty_status ty_film_check(const ty_command* command, const char* output, const char* const* endings,
                                   ty_output_form form);
// Makes a recipe: as ty_recipe_make, or as a film whose frames lie in a folder of their own until it is there. What
// went wrong is logged.
TY_CHECKED ty_status ty_film_make(const char* recipe, const char* kind, const char* output, double fps,
                                  const ty_scene_options* options);
