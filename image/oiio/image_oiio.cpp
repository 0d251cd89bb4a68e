// SPDX-License-Identifier: Apache-2.0
// The shim over OpenImageIO: alpha as stored, no threads of its own, no dither, no time stamps.
#include "oiio_guard.h"
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <memory>
#include <vector>

struct ty_oiio_input
{
    std::unique_ptr<OIIO::ImageInput> file;
};

struct ty_oiio_output
{
    std::vector<unsigned char> bytes;
};

void ty_oiio_set_up()
{
    static const bool done = []
    {
        // Both, or OpenImageIO and the OpenEXR library start pools of their own.
        OIIO::attribute("threads", 1);
        OIIO::attribute("exr_threads", -1);
        OIIO::attribute("try_all_readers", 0);
        return true;
    }();
    (void)done;
}

void ty_oiio_set_text(char* text, size_t size, const std::string& message)
{
    std::snprintf(text, size, "%s", message.empty() ? "unknown reason" : message.c_str());
    size_t length = 0;
    for (size_t i = 0; text[i]; i++)
    {
        if (text[i] == '\n' || text[i] == '\r')
            text[i] = ' ';
        if (text[i] != ' ')
            length = i + 1;
    }
    text[length] = 0;
}

namespace
{

void fill_info(const OIIO::ImageSpec& spec, ty_oiio_info* info)
{
    *info = ty_oiio_info();
    info->width = spec.width;
    info->height = spec.height;
    info->channels = spec.nchannels;
    info->bytes_per_channel = int(spec.format.size());
    for (const OIIO::TypeDesc& type : spec.channelformats)
        info->bytes_per_channel = std::max(info->bytes_per_channel, int(type.size()));
    info->is_float = spec.format.is_floating_point();
    std::snprintf(info->color_space, sizeof info->color_space, "%s",
                  spec.get_string_attribute("oiio:ColorSpace").c_str());
    const OIIO::TypeDesc eight_floats(OIIO::TypeDesc::FLOAT, 8);
    const OIIO::ParamValue* chromaticities = spec.find_attribute("chromaticities", eight_floats);
    if (chromaticities)
    {
        const float* values = static_cast<const float*>(chromaticities->data());
        std::copy(values, values + 8, info->chromaticities);
        info->has_chromaticities = 1;
    }
}

} // namespace

ty_oiio_result ty_oiio_open(const char* format, const char* path, ty_oiio_input** out, ty_oiio_info* info, char* text,
                            size_t text_size)
{
    *out = nullptr;
    return ty_oiio_guarded(text, text_size,
                           [&]
                           {
                               ty_oiio_set_up();
                               std::unique_ptr<OIIO::ImageInput> file = OIIO::ImageInput::create(format);
                               if (!file)
                                   return ty_oiio_fail(text, text_size, OIIO::geterror());
                               OIIO::ImageSpec config, spec;
                               config.attribute("oiio:UnassociatedAlpha", 1);
                               if (!file->open(path, spec, config))
                                   return ty_oiio_fail(text, text_size, file->geterror());
                               fill_info(spec, info);
                               *out = new ty_oiio_input{std::move(file)};
                               return TY_OIIO_OK;
                           });
}

ty_oiio_result ty_oiio_read(ty_oiio_input* input, int begin, int end, float* pixels, char* text, size_t text_size)
{
    return ty_oiio_guarded(text, text_size,
                           [&]
                           {
                               OIIO::ImageInput& file = *input->file;
                               // A JPEG that ends early reads as grey with a warning that stands only in the error
                               // text.
                               const bool good = file.read_image(0, 0, begin, end, OIIO::TypeDesc::FLOAT, pixels);
                               if (!good || file.has_error())
                                   return ty_oiio_fail(text, text_size, file.geterror());
                               return TY_OIIO_OK;
                           });
}

const char* ty_oiio_channel_name(const ty_oiio_input* input, int channel)
{
    const std::vector<std::string>& names = input->file->spec().channelnames;
    return size_t(channel) < names.size() ? names[size_t(channel)].c_str() : "";
}

void ty_oiio_close(ty_oiio_input* input)
{
    if (!input)
        return;
    char text[64];
    // Pending messages would be printed by the destructor.
    (void)ty_oiio_guarded(text, sizeof text,
                          [&]
                          {
                              (void)input->file->geterror();
                              input->file->close();
                              (void)input->file->geterror();
                              delete input;
                              return TY_OIIO_OK;
                          });
}

ty_oiio_result ty_oiio_encode(const char* format, int width, int height, int channels, int bits, const void* levels,
                              const char* color_space, ty_oiio_output** out, char* text, size_t text_size)
{
    *out = nullptr;
    return ty_oiio_guarded(text, text_size,
                           [&]
                           {
                               ty_oiio_set_up();
                               auto output = std::make_unique<ty_oiio_output>();
                               OIIO::Filesystem::IOVecOutput memory(output->bytes);
                               void* proxy = &memory;
                               std::unique_ptr<OIIO::ImageOutput> file = OIIO::ImageOutput::create(format);
                               if (!file || !file->supports("ioproxy"))
                                   return ty_oiio_fail(text, text_size,
                                                       file ? "cannot be written in memory" : OIIO::geterror());
                               const OIIO::TypeDesc type = bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8;
                               OIIO::ImageSpec spec(width, height, channels, type);
                               spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
                               spec.attribute("oiio:UnassociatedAlpha", 1);
                               if (color_space[0])
                                   spec.attribute("oiio:ColorSpace", color_space);
                               if (std::string(format) == "jpeg")
                                   spec.attribute("Compression", "jpeg:95");
                               if (std::string(format) == "tiff")
                               {
                                   spec.attribute("Compression", "zip");
                                   spec.attribute("DateTime", 0); // not a date, so that none is written
                               }
                               const std::string name = std::string("memory.") + format;
                               if (!file->open(name, spec) || !file->write_image(type, levels) || !file->close())
                                   return ty_oiio_fail(text, text_size, file->geterror());
                               *out = output.release();
                               return TY_OIIO_OK;
                           });
}

const void* ty_oiio_output_bytes(const ty_oiio_output* output, size_t* size)
{
    *size = output->bytes.size();
    return output->bytes.data();
}

void ty_oiio_output_destroy(ty_oiio_output* output)
{
    delete output;
}
