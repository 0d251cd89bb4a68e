// SPDX-License-Identifier: Apache-2.0
// Any bytes as the state of a pile: refused, or a pile that goes on and is saved as it was.
#include <string.h>
#include <tsuya/generate/pile.h>

enum
{
    VARIANTS = 2,
    LARGEST = 16384, // bytes: a hundred bodies in one place have many contacts
};

int LLVMFuzzerInitialize(int* argc, char*** argv);
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

static ty_element grains[VARIANTS];
static ty_container* box;

int LLVMFuzzerInitialize(int* argc, char*** argv)
{
    (void)argc;
    (void)argv;
    ty_error error;
    ty_element_def element = ty_element_def_default();
    element.kind = TY_ELEMENT_BALL;
    ty_container_def container = ty_container_def_default();
    container.kind = TY_CONTAINER_BOX;
    container.shape.size = ty_vec3_make(0.03f, 0.02f, 0.03f);
    ty_status status = ty_element_complete(&element, "element", &error);
    for (int i = 0; i < VARIANTS && status == TY_OK; i++)
        status = ty_element_init(&element, (ty_seed){1}, i, &grains[i], &error);
    if (status == TY_OK)
        status = ty_container_create(&container, NULL, &box, &error);
    TY_ASSERT(status == TY_OK);
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    ty_pile_def def = ty_pile_def_default();
    def.grains = grains;
    def.grain_count = VARIANTS;
    def.container = box;
    def.bridge = ty_bridge_of_moisture(0.5f);
    ty_pile* pile = ty_pile_create(&def);
    ty_error error;
    ty_bytes again;
    ty_status status = size <= LARGEST ? ty_pile_restore(pile, data, size, NULL, &error) : TY_BAD_FILE;
    TY_ASSERT(status == TY_OK || status == TY_BAD_FILE);
    if (status == TY_OK)
    {
        status = ty_pile_save(pile, &again, &error);
        TY_ASSERT(status == TY_OK);
        ty_bytes_term(&again);
        for (int i = 0; i < 3; i++)
            ty_pile_step(pile, NULL);
    }
    ty_pile_destroy(pile);
    return 0;
}
