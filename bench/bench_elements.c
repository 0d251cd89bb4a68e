// SPDX-License-Identifier: Apache-2.0
// Elements of every kind: triangles, balls, how far both are apart, and the CPU time that one takes. bench_elements
// [VARIANTS]: means over so many (8).
#include "cpu_time.h"
#include <stdio.h>
#include <stdlib.h>
#include <tsuya/generate/element.h>

static void measure(const char* name, const ty_element_def* def, int variants)
{
    static ty_element e;
    double triangles = 0.0, worst = 0.0, start = cpu_seconds();
    int least = TY_ELEMENT_MAX_BALLS, most = 0;
    for (int v = 0; v < variants; v++)
    {
        ty_error error;
        if (ty_element_init(def, (ty_seed){5}, v, &e, &error) != TY_OK)
        {
            fprintf(stderr, "bench_elements: %s: %s\n", name, error.text);
            exit(1);
        }
        triangles += e.mesh->triangle_count / (double)variants;
        least = e.ball_count < least ? e.ball_count : least;
        most = e.ball_count > most ? e.ball_count : most;
        worst = fmax(worst, (double)(e.fit_max / e.width));
        ty_element_term(&e);
    }
    printf("%-22s %9.0f %5d-%-3d %7.2f %9.0f\n", name, triangles, least, most, 100.0 * worst,
           1e3 * (cpu_seconds() - start) / variants);
}

int main(int argc, char** argv)
{
    static const struct
    {
        const char* name;
        int kind, cultivar, bean, model;
    } cases[] = {{"rice, japonica", TY_ELEMENT_RICE, TY_CULTIVAR_JAPONICA, 0, TY_RICE_FORMULA},
                 {"rice, indica", TY_ELEMENT_RICE, TY_CULTIVAR_INDICA, 0, TY_RICE_FORMULA},
                 {"rice, aromatic", TY_ELEMENT_RICE, TY_CULTIVAR_AROMATIC, 0, TY_RICE_FORMULA},
                 {"rice, glutinous", TY_ELEMENT_RICE, TY_CULTIVAR_GLUTINOUS, 0, TY_RICE_FORMULA},
                 {"field rice, japonica", TY_ELEMENT_RICE, TY_CULTIVAR_JAPONICA, 0, TY_RICE_FIELD},
                 {"field rice, indica", TY_ELEMENT_RICE, TY_CULTIVAR_INDICA, 0, TY_RICE_FIELD},
                 {"field rice, aromatic", TY_ELEMENT_RICE, TY_CULTIVAR_AROMATIC, 0, TY_RICE_FIELD},
                 {"field rice, glutinous", TY_ELEMENT_RICE, TY_CULTIVAR_GLUTINOUS, 0, TY_RICE_FIELD},
                 {"roe", TY_ELEMENT_ROE, 0, 0, 0},
                 {"ball", TY_ELEMENT_BALL, 0, 0, 0},
                 {"ice", TY_ELEMENT_ICE, 0, 0, 0},
                 {"grape", TY_ELEMENT_GRAPE, 0, 0, 0},
                 {"bean, red", TY_ELEMENT_BEAN, 0, TY_BEAN_RED, 0},
                 {"bean, black", TY_ELEMENT_BEAN, 0, TY_BEAN_BLACK, 0},
                 {"bean, white", TY_ELEMENT_BEAN, 0, TY_BEAN_WHITE, 0},
                 {"tofu", TY_ELEMENT_TOFU, 0, 0, 0},
                 {"pebble", TY_ELEMENT_PEBBLE, 0, 0, 0}};
    int variants = argc > 1 ? atoi(argv[1]) : 8;
    if (variants < 1 || variants > TY_ELEMENT_MAX_VARIANTS)
    {
        fprintf(stderr, "bench_elements [VARIANTS]: 1..%d\n", TY_ELEMENT_MAX_VARIANTS);
        return 2;
    }
    printf("%-22s %9s %9s %7s %9s\n", "", "triangles", "balls", "fit %", "CPU ms");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    {
        ty_element_def def = ty_element_def_default();
        def.kind = cases[i].kind;
        def.cultivar = cases[i].cultivar;
        def.bean = cases[i].bean;
        def.model = cases[i].model;
        measure(cases[i].name, &def, variants);
    }
    return 0;
}
