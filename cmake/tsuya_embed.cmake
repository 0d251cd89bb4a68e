# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT: a C source with the bytes of each of INPUTS as ty_<NAME>_<extension>, ended by a zero. Run by tsuya_embed.
set(text "// Made from the files of ${NAME} by the build.\n")
foreach(input ${INPUTS})
    get_filename_component(extension ${input} LAST_EXT)
    string(SUBSTRING ${extension} 1 -1 extension)
    file(READ ${input} bytes HEX)
    string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
    string(APPEND text "extern const char ty_${NAME}_${extension}[];\nconst char ty_${NAME}_${extension}[] = {${bytes}0};\n")
endforeach()
file(WRITE ${OUTPUT} "${text}")
