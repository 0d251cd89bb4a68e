// SPDX-License-Identifier: Apache-2.0
// The shim over OpenImageIO's image cache, and the writer of the files that it reads.
#include "tiles_oiio.h"
#include "oiio_guard.h"
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagecache.h>
#include <atomic>
#include <memory>

#define KEY "tsuya:key"

struct ty_oiio_tiles
{
    OIIO::ImageCache* cache = nullptr;
    uint64_t serial = 0; // no other cache of this process has it

    ty_oiio_tiles() = default;
    ty_oiio_tiles(const ty_oiio_tiles&) = delete;
    ty_oiio_tiles& operator=(const ty_oiio_tiles&) = delete;
    ~ty_oiio_tiles()
    {
        (void)cache->geterror(); // pending messages would be printed
        OIIO::ImageCache::destroy(cache, true);
    }
};

namespace
{

// A thread asks for its own part of the cache once, not at every lookup.
OIIO::ImageCache::Perthread* perthread_of(const ty_oiio_tiles* tiles)
{
    static thread_local uint64_t serial = 0;
    static thread_local OIIO::ImageCache::Perthread* mine = nullptr;
    if (serial != tiles->serial)
    {
        mine = tiles->cache->get_perthread_info();
        serial = tiles->serial;
    }
    return mine;
}

OIIO::ImageInput* open_exr()
{
    return OIIO::ImageInput::create("openexr").release();
}

template <class Number> uint64_t statistic(const ty_oiio_tiles* tiles, const char* name, OIIO::TypeDesc type)
{
    Number value = 0;
    return tiles->cache->getattribute(name, type, &value) && value > 0 ? uint64_t(value) : 0;
}

int level_side(int side, int level)
{
    return std::max(1, side >> level);
}

bool is_ours(const OIIO::ImageSpec& spec, const char* key)
{
    return spec.get_string_attribute(KEY) == key && spec.format == OIIO::TypeDesc::HALF &&
           spec.tile_width == TY_TILE_SIZE && spec.tile_height == TY_TILE_SIZE && spec.x == 0 && spec.y == 0 &&
           spec.nchannels >= 1 && spec.nchannels <= 4;
}

} // namespace

ty_oiio_result ty_oiio_tiles_create(uint64_t memory_bytes, ty_oiio_tiles** out, char* text, size_t text_size)
{
    *out = nullptr;
    return ty_oiio_guarded(text, text_size,
                           [&]
                           {
                               static std::atomic<uint64_t> serials{0};
                               ty_oiio_set_up();
                               OIIO::ImageCache* cache = OIIO::ImageCache::create(false);
                               const double megabytes = double(memory_bytes) / (1024.0 * 1024.0);
                               cache->attribute("max_memory_MB", float(std::max(16.0, megabytes)));
                               cache->attribute("max_open_files", 64);
                               cache->attribute("accept_untiled", 0);
                               cache->attribute("accept_unmipped", 0);
                               cache->attribute("deduplicate", 0);
                               auto tiles = std::make_unique<ty_oiio_tiles>();
                               tiles->cache = cache;
                               tiles->serial = ++serials;
                               *out = tiles.release();
                               return TY_OIIO_OK;
                           });
}

void ty_oiio_tiles_destroy(ty_oiio_tiles* tiles)
{
    if (!tiles)
        return;
    char text[64];
    (void)ty_oiio_guarded(text, sizeof text,
                          [&]
                          {
                              delete tiles;
                              return TY_OIIO_OK;
                          });
}

void ty_oiio_tiles_get_stats(const ty_oiio_tiles* tiles, ty_oiio_tile_stats* out)
{
    out->bytes_now = statistic<long long>(tiles, "stat:cache_memory_used", OIIO::TypeDesc::INT64);
    out->tiles_read = statistic<int>(tiles, "stat:tiles_created", OIIO::TypeDesc::INT);
    out->tiles_peak = statistic<int>(tiles, "stat:tiles_peak", OIIO::TypeDesc::INT);
    out->bytes_read = statistic<long long>(tiles, "stat:bytes_read", OIIO::TypeDesc::INT64);
}

ty_oiio_result ty_oiio_tiles_open(ty_oiio_tiles* tiles, const char* path, const char* key, ty_oiio_tile_file* out,
                                  char* text, size_t text_size)
{
    *out = ty_oiio_tile_file();
    return ty_oiio_guarded(
        text, text_size,
        [&]
        {
            OIIO::ImageCache& cache = *tiles->cache;
            const OIIO::ustring name(path);
            OIIO::ImageSpec spec;
            int levels = 0;
            // A file that was refused before may have been written anew.
            if (!cache.add_file(name, open_exr, nullptr, true) || !cache.get_imagespec(name, spec, 0, 0) ||
                !cache.get_image_info(name, 0, 0, OIIO::ustring("miplevels"), OIIO::TypeDesc::INT, &levels))
                return ty_oiio_fail(text, text_size, cache.geterror());
            const int longest = std::max(spec.width, spec.height);
            if (!is_ours(spec, key) || levels < 1 || levels > TY_LEVELS_MAX || level_side(longest, levels - 1) != 1)
                return ty_oiio_fail(text, text_size, "it holds something else");
            out->handle = cache.get_image_handle(name);
            out->width = spec.width;
            out->height = spec.height;
            out->channels = spec.nchannels;
            out->level_count = levels;
            return TY_OIIO_OK;
        });
}

const uint16_t* ty_oiio_tile_take(ty_oiio_tiles* tiles, const ty_oiio_tile_file* file, int level, int x, int y,
                                  void** tile)
{
    *tile = nullptr;
    try
    {
        auto* handle = static_cast<OIIO::ImageCache::ImageHandle*>(file->handle);
        OIIO::ImageCache::Tile* taken = tiles->cache->get_tile(handle, perthread_of(tiles), 0, level, x, y, 0);
        if (!taken)
            return nullptr;
        OIIO::TypeDesc format;
        const void* texels = tiles->cache->tile_pixels(taken, format);
        if (texels && format == OIIO::TypeDesc::HALF)
        {
            *tile = taken;
            return static_cast<const uint16_t*>(texels);
        }
        tiles->cache->release_tile(taken);
    }
    catch (...)
    {
        // Out of memory: as a tile that cannot be read.
    }
    return nullptr;
}

void ty_oiio_tile_give(ty_oiio_tiles* tiles, void* tile)
{
    if (tile)
        tiles->cache->release_tile(static_cast<OIIO::ImageCache::Tile*>(tile));
}

void ty_oiio_tiles_get_error(ty_oiio_tiles* tiles, char* text, size_t text_size)
{
    text[0] = 0;
    (void)ty_oiio_guarded(text, text_size,
                          [&]
                          {
                              ty_oiio_set_text(text, text_size, tiles->cache->geterror());
                              return TY_OIIO_OK;
                          });
}

namespace
{

bool write_levels(OIIO::ImageOutput& output, const char* path, OIIO::ImageSpec spec, const uint16_t* const* levels,
                  int level_count)
{
    const int width = spec.width, height = spec.height;
    for (int level = 0; level < level_count; level++)
    {
        spec.width = spec.full_width = level_side(width, level);
        spec.height = spec.full_height = level_side(height, level);
        const auto mode = level == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendMIPLevel;
        if (!output.open(path, spec, mode) || !output.write_image(OIIO::TypeDesc::HALF, levels[level]))
            return false;
    }
    return output.close();
}

} // namespace

ty_oiio_result ty_oiio_tiled_write(const char* path, const char* key, int width, int height, int channels,
                                   const uint16_t* const* levels, int level_count, char* text, size_t text_size)
{
    return ty_oiio_guarded(
        text, text_size,
        [&]
        {
            ty_oiio_set_up();
            OIIO::Filesystem::IOFile file(path, OIIO::Filesystem::IOProxy::Write);
            std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("openexr");
            if (!output || !file.handle())
                return ty_oiio_fail(text, text_size, output ? "cannot open the file" : OIIO::geterror());
            void* proxy = &file;
            OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::HALF);
            spec.tile_width = spec.tile_height = TY_TILE_SIZE;
            spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
            spec.attribute("textureformat", "Plain Texture");
            spec.attribute("openexr:roundingmode", 0); // down
            spec.attribute("compression", "zip:2");    // levels above pack hardly better and take several times as long
            spec.attribute("DateTime", "");
            spec.attribute(KEY, key);
            const bool good = write_levels(*output, path, spec, levels, level_count);
            // The library does not look at what the last flush says.
            if (!good || std::fflush(file.handle()) != 0 || std::ferror(file.handle()))
                return ty_oiio_fail(text, text_size, good ? "cannot write to the end" : output->geterror());
            return TY_OIIO_OK;
        });
}
