// SPDX-License-Identifier: Apache-2.0
// The shim over OpenColorIO: a configuration, its names gathered once, and processors kept by name.
#include "color_ocio.h"
#include <OpenColorIO/OpenColorIO.h>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <map>
#include <mutex>
#include <new>
#include <sstream>
#include <string>
#include <vector>

namespace OCIO = OCIO_NAMESPACE;

struct ty_ocio
{
    OCIO::ConstConfigRcPtr config;
    std::string identity;
    std::vector<std::string> spaces, displays;
    std::map<std::string, std::vector<std::string>> views;
    mutable std::mutex guard; // of processors
    mutable std::map<std::string, OCIO::ConstCPUProcessorRcPtr> processors;
};

namespace
{

ty_ocio_result fail(char* text, size_t size, const char* message)
{
    std::snprintf(text, size, "%s", message);
    std::replace(text, text + std::char_traits<char>::length(text), '\n', ' ');
    return TY_OCIO_FAILED;
}

template <class Function> ty_ocio_result guarded(char* text, size_t size, Function function)
{
    try
    {
        return function();
    }
    catch (const std::bad_alloc&)
    {
        return TY_OCIO_NO_MEMORY;
    }
    catch (const std::exception& exception)
    {
        return fail(text, size, exception.what());
    }
    catch (...)
    {
        return fail(text, size, "unknown exception");
    }
}

// Without the files it refers to where one of them cannot be read: a conversion that needs it will say so.
std::string identity_of(const OCIO::ConstConfigRcPtr& config)
{
    try
    {
        return config->getCacheID();
    }
    catch (const OCIO::Exception&)
    {
        return config->getCacheID(OCIO::ConstContextRcPtr());
    }
}

// The default first, the others in the configuration's order.
void put_first(std::vector<std::string>& names, const char* first)
{
    auto found = std::find(names.begin(), names.end(), first);
    if (found != names.end())
        std::rotate(names.begin(), found, found + 1);
}

void gather_names(ty_ocio& ocio)
{
    const OCIO::ConstConfigRcPtr& config = ocio.config;
    const int count = config->getNumColorSpaces(OCIO::SEARCH_REFERENCE_SPACE_SCENE, OCIO::COLORSPACE_ALL);
    std::vector<std::string> aliases;
    for (int i = 0; i < count; i++)
    {
        const char* name =
            config->getColorSpaceNameByIndex(OCIO::SEARCH_REFERENCE_SPACE_SCENE, OCIO::COLORSPACE_ALL, i);
        ocio.spaces.push_back(name);
        const OCIO::ConstColorSpaceRcPtr space = config->getColorSpace(name);
        for (size_t k = 0; space && k < space->getNumAliases(); k++)
            aliases.push_back(space->getAlias(k));
    }
    ocio.spaces.insert(ocio.spaces.end(), aliases.begin(), aliases.end());
    for (int i = 0; i < config->getNumDisplays(); i++)
    {
        const std::string display = config->getDisplay(i);
        ocio.displays.push_back(display);
        std::vector<std::string>& views = ocio.views[display];
        for (int k = 0; k < config->getNumViews(display.c_str()); k++)
            views.push_back(config->getView(display.c_str(), k));
        put_first(views, config->getDefaultView(display.c_str()));
    }
    put_first(ocio.displays, config->getDefaultDisplay());
}

const char* name_at(const std::vector<std::string>& names, int index)
{
    return index >= 0 && size_t(index) < names.size() ? names[size_t(index)].c_str() : nullptr;
}

// The processor kept under key, made when it is asked for the first time. Its object lives as long as the
// configuration.
template <class Make> const OCIO::CPUProcessor& processor(const ty_ocio& ocio, const std::string& key, Make make)
{
    const std::lock_guard<std::mutex> lock(ocio.guard);
    OCIO::ConstCPUProcessorRcPtr& kept = ocio.processors[key];
    if (!kept)
        kept = make()->getDefaultCPUProcessor();
    return *kept;
}

void apply(const OCIO::CPUProcessor& processor, float* pixels, long pixel_count, int channels)
{
    OCIO::PackedImageDesc image(pixels, pixel_count, 1, channels);
    processor.apply(image);
}

void quiet(const char*)
{
}

} // namespace

ty_ocio_result ty_ocio_load(const char* path, const char* embedded, ty_ocio** out, char* text, size_t text_size)
{
    *out = nullptr;
    return guarded(text, text_size,
                   [&]
                   {
                       // Both: the variable OCIO_LOGGING_LEVEL overrules the level.
                       OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
                       OCIO::SetLoggingFunction(quiet);
                       auto ocio = std::make_unique<ty_ocio>();
                       if (path)
                           ocio->config = OCIO::Config::CreateFromFile(path);
                       else
                       {
                           std::istringstream stream(embedded);
                           ocio->config = OCIO::Config::CreateFromStream(stream);
                       }
                       ocio->config->validate();
                       ocio->identity = identity_of(ocio->config);
                       gather_names(*ocio);
                       *out = ocio.release();
                       return TY_OCIO_OK;
                   });
}

void ty_ocio_close(ty_ocio* ocio)
{
    delete ocio;
}

const char* ty_ocio_identity(const ty_ocio* ocio)
{
    return ocio->identity.c_str();
}

int ty_ocio_knows(const ty_ocio* ocio, const char* name)
{
    char text[8];
    bool known = false;
    const ty_ocio_result result = guarded(text, sizeof text,
                                          [&]
                                          {
                                              known = ocio->config->getColorSpace(name) != nullptr;
                                              return TY_OCIO_OK;
                                          });
    return result == TY_OCIO_OK && known;
}

const char* ty_ocio_space(const ty_ocio* ocio, int index)
{
    return name_at(ocio->spaces, index);
}

const char* ty_ocio_display(const ty_ocio* ocio, int index)
{
    return name_at(ocio->displays, index);
}

const char* ty_ocio_view(const ty_ocio* ocio, const char* display, int index)
{
    const auto found = ocio->views.find(display);
    return found == ocio->views.end() ? nullptr : name_at(found->second, index);
}

ty_ocio_result ty_ocio_convert(const ty_ocio* ocio, const char* from, const char* to, float* pixels, long pixel_count,
                               int channels, char* text, size_t text_size)
{
    return guarded(text, text_size,
                   [&]
                   {
                       const std::string key = std::string("space\n") + from + "\n" + to;
                       apply(processor(*ocio, key, [&] { return ocio->config->getProcessor(from, to); }), pixels,
                             pixel_count, channels);
                       return TY_OCIO_OK;
                   });
}

ty_ocio_result ty_ocio_develop(const ty_ocio* ocio, const char* from, const char* display, const char* view,
                               float* pixels, long pixel_count, int channels, char* text, size_t text_size)
{
    return guarded(text, text_size,
                   [&]
                   {
                       const std::string key = std::string("view\n") + from + "\n" + display + "\n" + view;
                       const auto make = [&]
                       { return ocio->config->getProcessor(from, display, view, OCIO::TRANSFORM_DIR_FORWARD); };
                       apply(processor(*ocio, key, make), pixels, pixel_count, channels);
                       return TY_OCIO_OK;
                   });
}
