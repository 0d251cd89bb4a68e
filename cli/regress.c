// SPDX-License-Identifier: Apache-2.0
// `tsuya regress`: scenes rendered and compared with their reference pictures.
#include "regress.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <tsuya/renderer/render.h>

typedef struct regress_job
{
    const ty_arguments* arguments;
    ty_scene_arguments scene; // options and workers
    ty_regression list;
    ty_regress_result* results; // [list.case_count]
    bool update;
} regress_job;

static void explain(ty_regress_result* result, ty_regress_verdict verdict, ty_status status, const char* format, ...)
    TY_PRINTF(4, 5);
static void explain(ty_regress_result* result, ty_regress_verdict verdict, ty_status status, const char* format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(result->text, sizeof result->text, format, list);
    va_end(list);
    result->verdict = verdict;
    result->status = status;
}

static void explain_error(ty_regress_result* result, const ty_error* error)
{
    char text[sizeof result->text];
    ty_error_format(error, text, sizeof text);
    explain(result, TY_REGRESS_FAULT, error->status, "%s", text);
}

// --- rendering ---

static unsigned aovs_of(const ty_param_strings* layers)
{
    static const struct
    {
        const char* layer;
        ty_aov aov;
    } known[] = {{"A", TY_AOV_ALPHA}, {"Z", TY_AOV_Z}, {"N", TY_AOV_N}, {"P", TY_AOV_P}, {"albedo", TY_AOV_ALBEDO}};
    unsigned aovs = 0;
    for (int i = 0; i < layers->count; i++)
    {
        for (int k = 0; k < TY_PARAM_COUNT(known); k++)
        {
            aovs |= strcmp(layers->items[i], known[k].layer) == 0 ? known[k].aov : 0u;
        }
    }
    return aovs;
}

static ty_status render_film(const regress_job* job, const ty_scene* scene, ty_regress_result* result, ty_film* film,
                             ty_exr** out, ty_error* error)
{
    ty_render_options options = {.sample_end = scene->render.samples};
    ty_render_stats stats = {0};
    ty_status status = ty_render(scene, &options, job->scene.options.workers, film, &stats, error);
    if (status == TY_OK)
    {
        const ty_film_write write = {.scene = scene, .sample_end = scene->render.samples};
        status = ty_film_to_exr(film, &write, out, error);
    }
    if (status == TY_OK && stats.nonfinite_samples > 0)
    {
        explain(result, TY_REGRESS_FAULT, TY_NON_FINITE,
                "%" PRIu64 " samples are not finite, the first at pixel %d,%d sample %d", stats.nonfinite_samples,
                stats.first_nonfinite[0], stats.first_nonfinite[1], stats.first_nonfinite[2]);
    }
    return status;
}

static ty_status render_scene(const regress_job* job, const ty_scene* scene, ty_regress_result* result, ty_exr** out,
                              ty_error* error)
{
    const int* size = scene->film.size;
    ty_film_setup setup = {.size = {size[0], size[1]},
                           .crop = {0, 0, size[0] - 1, size[1] - 1},
                           .sample_end = scene->render.samples,
                           .aovs = aovs_of(&result->of->layers),
                           .half = scene->film.half};
    ty_film* film;
    ty_status status = ty_film_create(&setup, &film, error);
    if (status == TY_OK)
    {
        status = render_film(job, scene, result, film, out, error);
        ty_film_destroy(film);
    }
    return status;
}

// The picture of a case; NULL after an explanation.
static ty_exr* render_case(regress_job* job, ty_regress_result* result)
{
    ty_scene_options options = job->scene.options;
    options.sets = result->of->set.items;
    options.set_count = result->of->set.count;
    options.variables = result->of->define.items;
    options.variable_count = result->of->define.count;
    ty_scene* scene = NULL;
    ty_exr* exr = NULL;
    ty_error error = {0};
    ty_error_list errors = {0};
    ty_status status = ty_scene_load(result->of->scene, &options, &scene, &errors);
    if (status != TY_OK && errors.count > 0)
    {
        explain_error(result, &errors.items[0]);
        result->status = status;
    }
    ty_errors_log(&errors);
    if (status == TY_OK)
    {
        status = render_scene(job, scene, result, &exr, &error);
        if (status != TY_OK)
        {
            error.status = status;
            explain_error(result, &error);
        }
    }
    ty_scene_destroy(scene);
    return exr;
}

// --- comparing ---

static void collect_limits(const ty_regression_limits* from, ty_regress_result* result)
{
    const float bounds[TY_METRIC_COUNT] = {from->rmse, from->relmse, from->trelmse, from->mae,
                                           from->psnr, from->max,    from->flip,    from->hdrflip};
    for (int m = 0; m < TY_METRIC_COUNT; m++)
    {
        bool rises = ty_metric_rises((ty_metric)m);
        if (rises ? bounds[m] > 0.0f : bounds[m] < TY_REGRESSION_UNJUDGED)
        {
            result->limits[result->limit_count++] = (ty_limit){(ty_metric)m, (double)bounds[m], rises};
        }
    }
}

static void judge(ty_regress_result* result)
{
    const ty_comparison* comparison = &result->comparison;
    if (comparison->differs)
    {
        explain(result, TY_REGRESS_DIFFERS, TY_DIFFERS, "%s", comparison->difference);
        return;
    }
    for (int i = 0; i < comparison->layer_count; i++)
    {
        const ty_compared_layer* layer = &comparison->layers[i];
        for (int k = 0; k < result->limit_count; k++)
        {
            const ty_limit* limit = &result->limits[k];
            if (ty_limit_breaks(limit, layer))
            {
                explain(result, TY_REGRESS_DIFFERS, TY_DIFFERS, "%s of %s is %.5g, %s the limit %.5g",
                        ty_metric_name(limit->metric), layer->layer.name, layer->value[limit->metric],
                        limit->below ? "below" : "above", limit->bound);
                return;
            }
        }
    }
    result->verdict = TY_REGRESS_PASSED;
}

static ty_status compare_case(const regress_job* job, ty_regress_result* result, const ty_picture* test,
                              ty_error* error)
{
    ty_picture reference;
    ty_status status = ty_picture_read(result->of->reference, &reference, error);
    if (status == TY_OK)
    {
        ty_comparison_def def = ty_comparison_def_default();
        def.layers = result->of->layers.items;
        def.layer_count = result->of->layers.count;
        def.develop.ocio = ty_argument_text(job->arguments, "ocio", NULL);
        def.keep = ty_argument_has(job->arguments, "html");
        def.workers = job->scene.options.workers;
        status = ty_compare(&reference, test, &def, &result->comparison, error);
    }
    ty_picture_term(&reference);
    return status;
}

static bool is_equal(const ty_comparison* comparison)
{
    bool equal = !comparison->differs;
    for (int i = 0; i < comparison->layer_count; i++)
    {
        equal = equal && comparison->layers[i].worst.value[TY_METRIC_MAX] == 0.0;
    }
    return equal;
}

static ty_status write_reference(const regress_job* job, const ty_regress_result* result, const ty_picture* test,
                                 ty_error* error)
{
    if (strcmp(ty_path_extension(result->of->reference), "exr") == 0)
    {
        return ty_exr_write(result->of->reference, test->exr, error);
    }
    ty_develop_def def = {.ocio = ty_argument_text(job->arguments, "ocio", NULL), .bits = 8};
    return ty_develop(test->exr, &def, result->of->reference, error);
}

static void update_case(const regress_job* job, ty_regress_result* result, const ty_picture* test)
{
    ty_error error = {0};
    bool there = ty_file_exists(result->of->reference);
    ty_status compared = there ? compare_case(job, result, test, &error) : TY_OK;
    const ty_comparison* comparison = &result->comparison;
    if (there && compared == TY_OK && is_equal(comparison))
    {
        explain(result, TY_REGRESS_KEPT, TY_OK, "%s is as rendered", result->of->reference);
        return;
    }
    if (write_reference(job, result, test, &error) != TY_OK)
    {
        explain_error(result, &error);
    }
    else if (!there)
    {
        explain(result, TY_REGRESS_UPDATED, TY_OK, "%s is new", result->of->reference);
    }
    else if (compared != TY_OK || comparison->differs)
    {
        explain(result, TY_REGRESS_UPDATED, TY_OK, "%s is replaced: %.700s", result->of->reference,
                comparison->differs ? comparison->difference : error.text);
    }
    else
    {
        explain(result, TY_REGRESS_UPDATED, TY_OK, "%s is replaced: rmse %.4g, flip %.4g to the old one",
                result->of->reference, comparison->layers[0].value[TY_METRIC_RMSE],
                comparison->layers[0].value[TY_METRIC_FLIP]);
    }
}

static void keep_picture(const regress_job* job, ty_regress_result* result, const ty_picture* test)
{
    const char* folder = ty_argument_text(job->arguments, "output", NULL);
    char name[80], path[TY_PATH_MAX];
    ty_error error;
    snprintf(name, sizeof name, "%s.exr", result->of->name);
    if (!folder)
    {
        return;
    }
    ty_path_join(folder, name, path);
    if (ty_exr_write(path, test->exr, &error) != TY_OK)
    {
        explain_error(result, &error);
    }
}

static void run_case(regress_job* job, ty_regress_result* result)
{
    double start = ty_time_now();
    collect_limits(&result->of->limits, result);
    ty_exr* exr = render_case(job, result);
    if (exr)
    {
        ty_picture test;
        ty_error error = {0};
        ty_picture_from_render(exr, result->of->name, &test);
        if (result->status == TY_OK && job->update)
        {
            update_case(job, result, &test);
        }
        else if (result->status == TY_OK && !ty_file_exists(result->of->reference))
        {
            explain(result, TY_REGRESS_DIFFERS, TY_DIFFERS, "there is no reference '%.600s' (--update makes it)",
                    result->of->reference);
        }
        else if (result->status == TY_OK && compare_case(job, result, &test, &error) == TY_OK)
        {
            judge(result);
        }
        else if (result->status == TY_OK)
        {
            explain_error(result, &error);
        }
        keep_picture(job, result, &test);
        ty_picture_term(&test);
    }
    result->seconds = ty_time_now() - start;
}

// --- results ---

static const char* const verdicts[] = {"passed", "DIFFERS", "FAILED", "updated", "unchanged", "not run"};

static void print_result(const ty_regress_result* result)
{
    printf("%-16s %-9s %6.1f s", result->of->name, verdicts[result->verdict], result->seconds);
    for (int i = 0; i < result->comparison.layer_count && !result->comparison.differs; i++)
    {
        const ty_compared_layer* layer = &result->comparison.layers[i];
        printf("  %s:", layer->layer.name);
        for (int k = 0; k < result->limit_count; k++)
        {
            const ty_limit* limit = &result->limits[k];
            if (!isnan(layer->value[limit->metric]))
            {
                printf(" %s %.4g (%.4g)", ty_metric_name(limit->metric), layer->value[limit->metric], limit->bound);
            }
        }
    }
    printf("%s%s\n", result->text[0] ? "  " : "", result->text);
    fflush(stdout);
}

static json_t* result_json(const ty_regress_result* result)
{
    json_t *root = json_object(), *metrics = json_object();
    json_object_set_new(root, "name", ty_json_from_text(result->of->name));
    json_object_set_new(root, "result",
                        json_string(result->verdict == TY_REGRESS_DIFFERS ? "differs"
                                    : result->verdict == TY_REGRESS_FAULT ? "failed"
                                                                          : verdicts[result->verdict]));
    json_object_set_new(root, "seconds", json_real(result->seconds));
    json_object_set_new(root, "text", ty_json_from_text(result->text));
    for (int i = 0; i < result->comparison.layer_count && !result->comparison.differs; i++)
    {
        const ty_compared_layer* layer = &result->comparison.layers[i];
        json_t* values = json_object();
        for (int m = 0; m < TY_METRIC_COUNT; m++)
        {
            bool known = isfinite(layer->value[m]);
            json_object_set_new(values, ty_metric_name((ty_metric)m), known ? json_real(layer->value[m]) : json_null());
        }
        json_object_set_new(metrics, layer->layer.name, values);
    }
    json_object_set_new(root, "metrics", metrics);
    return root;
}

static ty_status print_json(const regress_job* job)
{
    json_t* array = json_array();
    for (int i = 0; i < job->list.case_count; i++)
    {
        if (job->results[i].verdict != TY_REGRESS_NOT_RUN)
        {
            json_array_append_new(array, result_json(&job->results[i]));
        }
    }
    return ty_json_print(array);
}

static ty_status write_page(const regress_job* job, const char* path, ty_error* error)
{
    ty_report_entry* entries = TY_ALLOC(ty_report_entry, job->list.case_count);
    int count = 0;
    for (int i = 0; i < job->list.case_count; i++)
    {
        const ty_regress_result* result = &job->results[i];
        if (result->verdict == TY_REGRESS_NOT_RUN)
        {
            continue;
        }
        bool shown = result->comparison.layer_count > 0 && !result->comparison.differs;
        entries[count++] = (ty_report_entry){.title = result->of->name,
                                             .reference = result->of->reference,
                                             .test = result->of->scene,
                                             .comparison = &result->comparison,
                                             .limits = result->limits,
                                             .limit_count = result->limit_count,
                                             .fault = shown ? NULL : result->text,
                                             .failed = ty_regress_failed(result)};
    }
    ty_status status = ty_comparison_report(path, job->list.path, entries, count, error);
    ty_free(entries);
    return status;
}

static ty_status write_reports(const regress_job* job, ty_error* error)
{
    const char* junit = ty_argument_text(job->arguments, "junit", NULL);
    const char* html = ty_argument_text(job->arguments, "html", NULL);
    ty_status status = junit ? ty_regress_junit(junit, job->results, job->list.case_count, error) : TY_OK;
    if (status == TY_OK && html)
    {
        status = write_page(job, html, error);
    }
    return status;
}

// The worst there was: a case that could not be judged before one that differs.
static ty_status overall(const regress_job* job)
{
    ty_status status = TY_OK;
    int passed = 0, count = 0;
    for (int i = 0; i < job->list.case_count; i++)
    {
        const ty_regress_result* result = &job->results[i];
        if (result->verdict == TY_REGRESS_NOT_RUN)
        {
            continue;
        }
        count++;
        passed += !ty_regress_failed(result);
        if (ty_regress_failed(result))
        {
            ty_log(TY_LOG_ERROR, "%s: %s", result->of->name, result->text);
            status = status == TY_OK || status == TY_DIFFERS ? result->status : status;
        }
    }
    ty_log(TY_LOG_INFO, "%d of %d %s", passed, count, job->update ? "are up to date now" : "passed");
    return status;
}

// --- the command ---

static ty_status choose_cases(regress_job* job)
{
    const ty_arguments* arguments = job->arguments;
    bool some = ty_argument_has(arguments, "only");
    for (int i = 0; i < job->list.case_count; i++)
    {
        job->results[i].of = &job->list.cases[i];
        job->results[i].verdict = some ? TY_REGRESS_NOT_RUN : TY_REGRESS_PASSED;
    }
    for (int k = 0; k < arguments->given_count; k++)
    {
        const ty_given* given = &arguments->given[k];
        bool found = strcmp(given->option->name, "only") != 0;
        for (int i = 0; i < job->list.case_count && !found; i++)
        {
            found = strcmp(job->list.cases[i].name, given->text) == 0;
            job->results[i].verdict = found ? TY_REGRESS_PASSED : job->results[i].verdict;
        }
        if (!found)
        {
            return ty_usage(arguments->command, "--only: %s has no case '%s'", job->list.path, given->text);
        }
    }
    return TY_OK;
}

static ty_status run_cases(regress_job* job)
{
    bool json = ty_argument_has(job->arguments, "json");
    for (int i = 0; i < job->list.case_count; i++)
    {
        ty_regress_result* result = &job->results[i];
        if (result->verdict == TY_REGRESS_NOT_RUN)
        {
            continue;
        }
        run_case(job, result);
        if (result->status == TY_INTERRUPTED || result->status == TY_TERMINATED)
        {
            return result->status;
        }
        if (!json)
        {
            print_result(result);
        }
    }
    return json ? print_json(job) : ty_output_finish();
}

static ty_status probe_outputs(const regress_job* job, ty_error* error)
{
    static const char* const names[] = {"junit", "html"};
    ty_status status = TY_OK;
    for (int i = 0; i < TY_PARAM_COUNT(names) && status == TY_OK; i++)
    {
        const char* path = ty_argument_text(job->arguments, names[i], NULL);
        status = path ? ty_output_probe(path, error) : TY_OK;
    }
    const char* folder = ty_argument_text(job->arguments, "output", NULL);
    return status == TY_OK && folder ? ty_folder_create(folder, error) : status;
}

static ty_status run_list(regress_job* job)
{
    ty_error error = {0};
    job->results = TY_ALLOC(ty_regress_result, job->list.case_count);
    ty_status status = choose_cases(job);
    status = status == TY_OK ? probe_outputs(job, &error) : status;
    status = status == TY_OK ? run_cases(job) : status;
    status = status == TY_OK ? write_reports(job, &error) : status;
    if (error.text[0])
    {
        ty_log_error(&error);
    }
    status = status == TY_OK ? overall(job) : status;
    for (int i = 0; i < job->list.case_count; i++)
    {
        ty_comparison_term(&job->results[i].comparison);
    }
    ty_free(job->results);
    return status;
}

static ty_status run(const ty_arguments* arguments)
{
    static regress_job job;
    ty_error_list errors = {0};
    job = (regress_job){.arguments = arguments, .update = ty_argument_has(arguments, "update")};
    ty_status status = ty_regression_load(arguments->positional[0], &job.list, &errors);
    ty_errors_log(&errors);
    status = status == TY_OK ? ty_scene_arguments_read(arguments, &job.scene) : status;
    status = status == TY_OK ? run_list(&job) : status;
    ty_scene_arguments_term(&job.scene);
    ty_regression_term(&job.list);
    return status;
}

static const ty_option options[] = {
    {"update", 0, NULL, "make the rendered pictures the references, and say what changed"},
    {"only", 0, "NAME", "only this case (repeatable)"},
    {"junit", 0, "F.xml", "results for a CI server"},
    {"html", 0, "F.html", "a page with pictures to flip and wipe, and the numbers"},
    {"output", 'o', "FOLDER", "keep the rendered pictures there"},
    {"json", 0, NULL, "results as JSON on standard output"},
    {"ocio", 0, "FILE", "OpenColorIO configuration"},
    {"cache", 0, "FOLDER", "where made assets are kept; none: nowhere"},
    {"sandbox", 0, NULL, "allow no file outside the scenes' folders"},
    {"isa", 0, "NAME", "pin the CPU kernels: sse2, sse4.2, avx, avx2, avx512"},
    {"threads", 't', "N", "worker threads (default: all cores)"},
};

const ty_command ty_command_regress = {
    "regress",
    "FOLDER",
    "render the scenes of a regress.yaml and compare them with their references",
    "tsuya regress tests/regress --junit out/regress.xml --html out/regress.html",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
