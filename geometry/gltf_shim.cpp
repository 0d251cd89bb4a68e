// SPDX-License-Identifier: Apache-2.0
// The glTF importer behind C calls.
#include "gltf_shim.h"
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <tiny_gltf.h>

struct ty_gltf
{
    tinygltf::Model model;
    std::vector<int> parents;
};

namespace
{

bool ignore_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int, void*)
{
    return true;
}

tinygltf::FsCallbacks closed_file_system()
{
    tinygltf::FsCallbacks callbacks = {};
    callbacks.FileExists = [](const std::string&, void*) { return false; };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&, void*)
    { return false; };
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*)
    { return false; };
    return callbacks;
}

void find_parents(ty_gltf& gltf)
{
    const auto& nodes = gltf.model.nodes;
    gltf.parents.assign(nodes.size(), -1);
    for (size_t i = 0; i < nodes.size(); i++)
        for (int child : nodes[i].children)
            gltf.parents.at(size_t(child)) = int(i);
}

const tinygltf::Value* instance_attributes(const ty_gltf* gltf, int node)
{
    const auto& extensions = gltf->model.nodes[size_t(node)].extensions;
    auto found = extensions.find("EXT_mesh_gpu_instancing");
    if (found == extensions.end() || !found->second.Has("attributes"))
        return nullptr;
    const tinygltf::Value& attributes = found->second.Get("attributes");
    return attributes.IsObject() ? &attributes : nullptr;
}

template <size_t size> void copy_numbers(const std::vector<double>& from, float (&to)[size])
{
    if (from.size() == size)
        for (size_t i = 0; i < size; i++)
            to[i] = float(from[i]);
}

// Where the elements of an accessor lie; begin is null when they reach beyond the bytes.
struct span
{
    const unsigned char* begin;
    size_t stride;
    size_t count;
    int width, component;
    bool normalized;
};

span span_of(const ty_gltf* gltf, int index)
{
    const tinygltf::Model& model = gltf->model;
    span none = {nullptr, 0, 0, 0, 0, false};
    if (index < 0 || size_t(index) >= model.accessors.size())
        return none;
    const tinygltf::Accessor& a = model.accessors[size_t(index)];
    if (a.bufferView < 0 || size_t(a.bufferView) >= model.bufferViews.size())
        return none;
    const tinygltf::BufferView& view = model.bufferViews[size_t(a.bufferView)];
    if (view.buffer < 0 || size_t(view.buffer) >= model.buffers.size())
        return none;
    const auto& data = model.buffers[size_t(view.buffer)].data;
    int stride = a.ByteStride(view), width = tinygltf::GetNumComponentsInType(uint32_t(a.type));
    int component = tinygltf::GetComponentSizeInBytes(uint32_t(a.componentType));
    if (stride <= 0 || width < 1 || width > 4 || component < 1 || a.count == 0)
        return none;
    size_t offset = view.byteOffset + a.byteOffset, element = size_t(width) * size_t(component);
    if (offset > data.size() || element > data.size() - offset ||
        (a.count - 1) > (data.size() - offset - element) / size_t(stride))
        return none;
    return {data.data() + offset, size_t(stride), a.count, width, a.componentType, a.normalized};
}

template <typename T> T value_at(const unsigned char* at, int i)
{
    T value;
    std::memcpy(&value, at + size_t(i) * sizeof(T), sizeof value);
    return value;
}

float read_float(const span& s, const unsigned char* at, int i)
{
    switch (s.component)
    {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return value_at<float>(at, i);
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return s.normalized ? std::max(float(value_at<int8_t>(at, i)) / 127.0f, -1.0f) : float(value_at<int8_t>(at, i));
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return s.normalized ? std::max(float(value_at<int16_t>(at, i)) / 32767.0f, -1.0f)
                            : float(value_at<int16_t>(at, i));
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return float(value_at<uint8_t>(at, i)) * (s.normalized ? 1.0f / 255.0f : 1.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return float(value_at<uint16_t>(at, i)) * (s.normalized ? 1.0f / 65535.0f : 1.0f);
    default:
        return float(value_at<uint32_t>(at, i));
    }
}

bool read_integer(const span& s, const unsigned char* at, uint32_t* out)
{
    switch (s.component)
    {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        *out = value_at<uint8_t>(at, 0);
        return true;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        *out = value_at<uint16_t>(at, 0);
        return true;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        *out = value_at<uint32_t>(at, 0);
        return true;
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
    {
        float value = value_at<float>(at, 0);
        if (!(value >= 0.0f && value <= 16777216.0f) || value != float(uint32_t(value)))
            return false;
        *out = uint32_t(value);
        return true;
    }
    default:
        return false;
    }
}

const char* nth_key(const std::map<std::string, int>& attributes, int i)
{
    if (i < 0 || size_t(i) >= attributes.size())
        return nullptr;
    return std::next(attributes.begin(), i)->first.c_str();
}

} // namespace

ty_gltf* ty_gltf_load(const void* bytes, size_t size, char* message, size_t message_size, bool* out_of_memory)
{
    *out_of_memory = false;
    try
    {
        auto gltf = std::make_unique<ty_gltf>();
        tinygltf::TinyGLTF loader;
        loader.SetImageLoader(ignore_image, nullptr);
        loader.SetFsCallbacks(closed_file_system());
        std::string problem, warning;
        if (loader.LoadBinaryFromMemory(&gltf->model, &problem, &warning, static_cast<const unsigned char*>(bytes),
                                        static_cast<unsigned int>(size)))
        {
            find_parents(*gltf);
            return gltf.release();
        }
        std::snprintf(message, message_size, "%s", problem.c_str());
    }
    catch (const std::bad_alloc&)
    {
        *out_of_memory = true;
        std::snprintf(message, message_size, "out of memory");
    }
    catch (const std::exception& e)
    {
        std::snprintf(message, message_size, "%s", e.what());
    }
    return nullptr;
}

void ty_gltf_destroy(ty_gltf* gltf)
{
    delete gltf;
}

int ty_gltf_mesh_count(const ty_gltf* gltf)
{
    return int(gltf->model.meshes.size());
}

int ty_gltf_primitive_count(const ty_gltf* gltf, int mesh)
{
    return int(gltf->model.meshes[size_t(mesh)].primitives.size());
}

int ty_gltf_vertex_accessor(const ty_gltf* gltf, int mesh, int primitive, const char* semantic)
{
    const tinygltf::Primitive& p = gltf->model.meshes[size_t(mesh)].primitives[size_t(primitive)];
    if (!semantic)
        return p.indices;
    auto found = p.attributes.find(semantic);
    return found == p.attributes.end() ? -1 : found->second;
}

const char* ty_gltf_vertex_semantic(const ty_gltf* gltf, int mesh, int primitive, int i)
{
    return nth_key(gltf->model.meshes[size_t(mesh)].primitives[size_t(primitive)].attributes, i);
}

int ty_gltf_node_count(const ty_gltf* gltf)
{
    return int(gltf->model.nodes.size());
}

ty_gltf_node ty_gltf_get_node(const ty_gltf* gltf, int node)
{
    const tinygltf::Node& n = gltf->model.nodes[size_t(node)];
    ty_gltf_node out = {};
    out.mesh = n.mesh;
    out.parent = gltf->parents[size_t(node)];
    out.instanced = instance_attributes(gltf, node) != nullptr;
    out.has_matrix = n.matrix.size() == 16;
    out.rotation[3] = out.scale[0] = out.scale[1] = out.scale[2] = 1.0f;
    copy_numbers(n.matrix, out.matrix);
    copy_numbers(n.translation, out.translation);
    copy_numbers(n.rotation, out.rotation);
    copy_numbers(n.scale, out.scale);
    return out;
}

int ty_gltf_instance_accessor(const ty_gltf* gltf, int node, const char* semantic)
{
    const tinygltf::Value* attributes = instance_attributes(gltf, node);
    if (!attributes || !attributes->Has(semantic))
        return -1;
    const tinygltf::Value& value = attributes->Get(semantic);
    return value.IsInt() ? value.Get<int>() : -1;
}

const char* ty_gltf_instance_semantic(const ty_gltf* gltf, int node, int i)
{
    const tinygltf::Value* attributes = instance_attributes(gltf, node);
    if (!attributes || i < 0 || size_t(i) >= attributes->Size())
        return nullptr;
    return std::next(attributes->Get<tinygltf::Value::Object>().begin(), i)->first.c_str();
}

uint32_t ty_gltf_accessor_count(const ty_gltf* gltf, int accessor)
{
    return uint32_t(span_of(gltf, accessor).count);
}

int ty_gltf_accessor_width(const ty_gltf* gltf, int accessor)
{
    return span_of(gltf, accessor).width;
}

bool ty_gltf_read_floats(const ty_gltf* gltf, int accessor, float* out)
{
    span s = span_of(gltf, accessor);
    if (!s.begin)
        return false;
    for (size_t k = 0; k < s.count; k++)
        for (int i = 0; i < s.width; i++)
            *out++ = read_float(s, s.begin + k * s.stride, i);
    return true;
}

bool ty_gltf_read_integers(const ty_gltf* gltf, int accessor, uint32_t* out)
{
    span s = span_of(gltf, accessor);
    if (!s.begin || s.width != 1)
        return false;
    for (size_t k = 0; k < s.count; k++)
        if (!read_integer(s, s.begin + k * s.stride, &out[k]))
            return false;
    return true;
}
