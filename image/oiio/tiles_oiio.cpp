// SPDX-License-Identifier: Apache-2.0
// The shim over OpenImageIO's image cache, and the writer of the files that it reads.
#include "tiles_oiio.h"
#include "oiio_guard.h"
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagecache.h>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <malloc.h>
#include <memory>
#include <mutex>
#include <vector>

#define KEY "tsuya:key"

namespace
{

// Asking the library for a tile takes locks and counts references: a thread looks first among those it took last.
struct shelf
{
    static constexpr int size = 32;
    struct place
    {
        const void* handle = nullptr;
        int level = 0, column = 0, row = 0;
        OIIO::ImageCache::Tile* tile = nullptr; // nullptr = nothing here
        const uint16_t* texels = nullptr;
    };
    place places[size];
    OIIO::ImageCache::Perthread* perthread = nullptr;
};

} // namespace

struct ty_oiio_tiles
{
    OIIO::ImageCache* cache = nullptr;
    uint64_t serial = 0; // no other cache of this process has it
    int opened = 0;      // files
    std::atomic<uint64_t> fetched{0};
    std::mutex guard; // of shelves
    std::vector<std::unique_ptr<shelf>> shelves;

    ty_oiio_tiles() = default;
    ty_oiio_tiles(const ty_oiio_tiles&) = delete;
    ty_oiio_tiles& operator=(const ty_oiio_tiles&) = delete;
    ~ty_oiio_tiles()
    {
        for (const std::unique_ptr<shelf>& one : shelves)
            for (const shelf::place& place : one->places)
                if (place.tile)
                    cache->release_tile(place.tile);
        (void)cache->geterror(); // pending messages would be printed
        OIIO::ImageCache::destroy(cache, true);
    }
};

namespace
{

// A thread asks for its own part of the cache once, not at every lookup.
shelf& shelf_of(ty_oiio_tiles* tiles)
{
    static thread_local uint64_t serial = 0;
    static thread_local shelf* mine = nullptr;
    if (serial != tiles->serial)
    {
        auto made = std::make_unique<shelf>();
        made->perthread = tiles->cache->get_perthread_info();
        const std::lock_guard<std::mutex> lock(tiles->guard);
        tiles->shelves.push_back(std::move(made));
        mine = tiles->shelves.back().get();
        serial = tiles->serial;
    }
    return *mine;
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
            out->order = ++tiles->opened;
            out->width = spec.width;
            out->height = spec.height;
            out->channels = spec.nchannels;
            out->level_count = levels;
            return TY_OIIO_OK;
        });
}

namespace
{

// What tiles leave behind when they go is scattered between those that stay: without this the heap grows to many times
// the limit, although no more than that is in use.
void give_back_pages(ty_oiio_tiles* tiles)
{
    const uint64_t often = 8192;
    if (++tiles->fetched % often == 0)
        (void)malloc_trim(0);
}

// Fills a place, or leaves it empty.
void fetch(ty_oiio_tiles* tiles, const ty_oiio_tile_file* file, OIIO::ImageCache::Perthread* perthread,
           shelf::place& place)
{
    OIIO::ImageCache& cache = *tiles->cache;
    if (place.tile)
        cache.release_tile(place.tile);
    place.tile = nullptr;
    place.texels = nullptr;
    auto* handle = static_cast<OIIO::ImageCache::ImageHandle*>(file->handle);
    OIIO::ImageCache::Tile* tile =
        cache.get_tile(handle, perthread, 0, place.level, place.column * TY_TILE_SIZE, place.row * TY_TILE_SIZE, 0);
    if (!tile)
        return;
    OIIO::TypeDesc format;
    const void* texels = cache.tile_pixels(tile, format);
    if (texels && format == OIIO::TypeDesc::HALF)
    {
        place.tile = tile;
        place.texels = static_cast<const uint16_t*>(texels);
    }
    else
        cache.release_tile(tile);
}

} // namespace

const uint16_t* ty_oiio_tile_take(ty_oiio_tiles* tiles, const ty_oiio_tile_file* file, int level, int column, int row)
{
    try
    {
        shelf& own = shelf_of(tiles);
        // Neighbours, levels and the two frames of a blend lie in different places.
        const unsigned key = unsigned(column) + 3u * unsigned(row) + 7u * unsigned(level) + unsigned(file->order) * 13u;
        shelf::place& place = own.places[key % shelf::size];
        if (place.tile && place.handle == file->handle && place.level == level && place.column == column &&
            place.row == row)
            return place.texels;
        place.handle = file->handle;
        place.level = level;
        place.column = column;
        place.row = row;
        fetch(tiles, file, own.perthread, place);
        give_back_pages(tiles);
        return place.texels;
    }
    catch (...)
    {
        return nullptr; // out of memory: as a tile that cannot be read
    }
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

// OpenEXR 3.1 waits for ever for its threads when a write of a tile throws: a full disk is told after the last tile.
class PatientFile : public OIIO::Filesystem::IOFile
{
  public:
    explicit PatientFile(const char* path) : IOFile(path, IOProxy::Write)
    {
    }
    size_t write(const void* bytes, size_t size) override
    {
        if (failure_ == 0 && IOFile::write(bytes, size) != size)
            failure_ = errno ? errno : EIO;
        return size;
    }
    int failure() const
    {
        return failure_;
    }

  private:
    int failure_ = 0;
};

} // namespace

ty_oiio_result ty_oiio_tiled_write(const char* path, const char* key, int width, int height, int channels,
                                   const uint16_t* const* levels, int level_count, char* text, size_t text_size)
{
    return ty_oiio_guarded(
        text, text_size,
        [&]
        {
            ty_oiio_set_up();
            PatientFile file(path);
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
            if (file.failure())
                return ty_oiio_fail(text, text_size, std::strerror(file.failure()));
            // The library does not look at what the last flush says.
            if (!good || std::fflush(file.handle()) != 0 || std::ferror(file.handle()))
                return ty_oiio_fail(text, text_size, good ? "cannot write to the end" : output->geterror());
            return TY_OIIO_OK;
        });
}
