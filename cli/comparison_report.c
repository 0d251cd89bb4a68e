// SPDX-License-Identifier: Apache-2.0
// Comparisons as one HTML page that needs nothing beside it: pictures are data URIs, the script is inside.
#include "comparison.h"
#include "markup.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>

static const char style[] =
    "body{background:#1c1c1c;color:#ddd;font:15px/1.4 system-ui,sans-serif;margin:2em auto;max-width:1100px;padding:0 "
    "1em}\n"
    "h1{font-size:1.4em}h2{font-size:1.1em;margin:2em 0 .4em}table{border-collapse:collapse;margin:.6em 0}\n"
    "th,td{padding:.15em .9em .15em 0;text-align:right;font-variant-numeric:tabular-nums}th:first-child,\n"
    "td:first-child{text-align:left}th{color:#999;font-weight:400}.bad{color:#ff7a6b}.good{color:#8fd18a}\n"
    ".view{position:relative;display:inline-block;max-width:100%;line-height:0;cursor:col-resize}\n"
    ".view img{max-width:100%;min-width:min(100%,480px);image-rendering:pixelated}\n"
    ".view img+img{position:absolute;left:0;top:0;width:100%}button{background:#333;color:#ddd;border:1px solid "
    "#555;\n"
    "padding:.2em .8em;margin:.2em .3em .4em 0;border-radius:3px}button.on{background:#666}.hint{color:#999}\n";

// Each view has its pictures in the order reference, test, heat.
static const char script[] =
    "document.querySelectorAll('.set').forEach(function(set){\n"
    "  var i=set.querySelectorAll('img'),b=set.querySelectorAll('button'),mode='wipe',timer=0,side=0;\n"
    "  function show(r,t,h,clip){i[0].style.opacity=r;i[1].style.opacity=t;i[2].style.opacity=h;\n"
    "    i[1].style.clipPath=clip||'none'}\n"
    "  function wipe(x){show(1,1,0,'inset(0 0 0 '+100*x+'%)')}\n"
    "  function choose(m){mode=m;clearInterval(timer);b.forEach(function(e){e.classList.toggle('on',e.value==m)});\n"
    "    if(m=='wipe')wipe(.5);if(m=='reference')show(1,0,0);if(m=='test')show(0,1,0);if(m=='heat')show(0,0,1);\n"
    "    if(m=='flip')timer=setInterval(function(){side=1-side;show(1-side,side,0)},500)}\n"
    "  b.forEach(function(e){e.onclick=function(){choose(e.value)}});\n"
    "  set.querySelector('.view').onmousemove=function(e){if(mode=='wipe'){var r=i[0].getBoundingClientRect();\n"
    "    wipe(Math.min(1,Math.max(0,(e.clientX-r.left)/r.width)))}};choose('wipe')});\n";

static ty_status put_image(FILE* file, const char* name, const ty_image* image, ty_error* error)
{
    ty_bytes bytes;
    ty_status status = ty_image_encode("picture.png", image, 8, &bytes, error);
    if (status == TY_OK)
    {
        fprintf(file, "<img alt=\"%s\" src=\"data:image/png;base64,", name);
        ty_markup_base64(file, &bytes);
        fputs("\">", file);
    }
    ty_bytes_term(&bytes);
    return status;
}

static ty_status put_view(FILE* file, const ty_compared_layer* layer, ty_error* error)
{
    static const char* const modes[] = {"wipe", "flip", "reference", "test", "heat"};
    fputs("<div class=\"set\"><div>", file);
    for (int i = 0; i < TY_PARAM_COUNT(modes); i++)
    {
        fprintf(file, "<button value=\"%s\">%s</button>", modes[i], modes[i]);
    }
    fputs("</div><div class=\"view\">", file);
    ty_image heat;
    ty_status status = ty_comparison_heat(layer, &heat, error);
    status = status == TY_OK ? put_image(file, "reference", &layer->shown[0], error) : status;
    status = status == TY_OK ? put_image(file, "test", &layer->shown[1], error) : status;
    status = status == TY_OK ? put_image(file, "heat", &heat, error) : status;
    ty_image_term(&heat);
    fputs("</div></div>\n", file);
    return status;
}

static void put_limits(FILE* file, const ty_report_entry* entry)
{
    for (int i = 0; i < entry->limit_count; i++)
    {
        const ty_limit* limit = &entry->limits[i];
        fprintf(file, "%s%s at %s %g", i ? ", " : "<p class=\"hint\">limits: ", ty_metric_name(limit->metric),
                limit->below ? "least" : "most", limit->bound);
    }
    fputs(entry->limit_count ? "</p>\n" : "", file);
}

static void put_table(FILE* file, const ty_report_entry* entry)
{
    fputs("<table><tr><th>layer</th>", file);
    for (int m = 0; m < TY_METRIC_COUNT; m++)
    {
        fprintf(file, "<th>%s</th>", ty_metric_name((ty_metric)m));
    }
    fputs("<th>farthest apart</th></tr>\n", file);
    for (int i = 0; i < entry->comparison->layer_count; i++)
    {
        const ty_compared_layer* layer = &entry->comparison->layers[i];
        unsigned broken = ty_limits_broken(entry->limits, entry->limit_count, layer);
        fputs("<tr><td>", file);
        ty_markup_text(file, layer->layer.name);
        fputs("</td>", file);
        for (int m = 0; m < TY_METRIC_COUNT; m++)
        {
            fprintf(file, "<td%s>", broken & 1u << m ? " class=\"bad\"" : "");
            fprintf(file, isnan(layer->value[m]) ? "–</td>" : "%.5g</td>", layer->value[m]);
        }
        fprintf(file, "<td>%d,%d: %.5g, %.5g</td></tr>\n", layer->worst.x, layer->worst.y,
                (double)layer->worst.reference, (double)layer->worst.test);
    }
    fputs("</table>\n", file);
}

static ty_status put_entry(FILE* file, const ty_report_entry* entry, ty_error* error)
{
    fputs("<h2>", file);
    ty_markup_text(file, entry->title);
    fprintf(file, " <span class=\"%s\">%s</span></h2>\n<p class=\"hint\">reference ", entry->failed ? "bad" : "good",
            entry->failed ? "differs" : "passed");
    ty_markup_text(file, entry->reference);
    fputs(", test ", file);
    ty_markup_text(file, entry->test);
    fputs("</p>\n", file);
    if (entry->fault)
    {
        fputs("<p class=\"bad\">", file);
        ty_markup_text(file, entry->fault);
        fputs("</p>\n", file);
        return TY_OK;
    }
    put_table(file, entry);
    put_limits(file, entry);
    ty_status status = TY_OK;
    for (int i = 0; i < entry->comparison->layer_count && status == TY_OK; i++)
    {
        status = put_view(file, &entry->comparison->layers[i], error);
    }
    return status;
}

typedef struct page
{
    const char* title;
    const ty_report_entry* entries;
    int count;
} page;

static ty_status put_page(FILE* file, const void* context, ty_error* error)
{
    const page* all = context;
    int failed = 0;
    for (int i = 0; i < all->count; i++)
    {
        failed += all->entries[i].failed;
    }
    fputs("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>", file);
    ty_markup_text(file, all->title);
    fprintf(file, "</title>\n<style>\n%s</style></head><body>\n<h1>", style);
    ty_markup_text(file, all->title);
    fprintf(file, "</h1>\n<p>%d compared, <span class=\"%s\">%d differ</span>. Move over a picture to wipe.</p>\n",
            all->count, failed ? "bad" : "good", failed);
    ty_status status = TY_OK;
    for (int i = 0; i < all->count && status == TY_OK; i++)
    {
        status = put_entry(file, &all->entries[i], error);
    }
    fprintf(file, "<script>\n%s</script></body></html>\n", script);
    return status;
}

ty_status ty_comparison_report(const char* path, const char* title, const ty_report_entry* entries, int count,
                               ty_error* error)
{
    const page all = {title, entries, count};
    return ty_output_write(path, put_page, &all, error);
}
