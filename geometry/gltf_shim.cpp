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

// Where elements lie; begin is null when they reach beyond the bytes, or when there are none.
struct plain_span
{
    const unsigned char* begin;
    size_t stride;
};

plain_span plain_span_of(const tinygltf::Model& model, int view_index, size_t byte_offset, size_t stride,
                         size_t element, size_t count)
{
    plain_span none = {nullptr, 0};
    if (view_index < 0 || size_t(view_index) >= model.bufferViews.size() || count == 0)
        return none;
    const tinygltf::BufferView& view = model.bufferViews[size_t(view_index)];
    if (view.buffer < 0 || size_t(view.buffer) >= model.buffers.size())
        return none;
    const auto& data = model.buffers[size_t(view.buffer)].data;
    size_t offset = view.byteOffset + byte_offset;
    if (offset > data.size() || element > data.size() - offset ||
        (count - 1) > (data.size() - offset - element) / stride)
        return none;
    return {data.data() + offset, stride};
}

// An accessor's elements: plain, or zero, and those that are sparse. count is 0 when something does not fit.
struct span
{
    plain_span values;
    size_t count;
    int width, component;
    bool normalized;
    plain_span sparse_indices, sparse_values;
    size_t sparse_count;
    int sparse_component;
};

span span_of(const ty_gltf* gltf, int index)
{
    const tinygltf::Model& model = gltf->model;
    span out = {};
    if (index < 0 || size_t(index) >= model.accessors.size())
        return out;
    const tinygltf::Accessor& a = model.accessors[size_t(index)];
    int width = tinygltf::GetNumComponentsInType(uint32_t(a.type));
    int component = tinygltf::GetComponentSizeInBytes(uint32_t(a.componentType));
    if (width < 1 || width > 4 || component < 1)
        return out;
    size_t element = size_t(width) * size_t(component);
    if (a.bufferView >= 0)
    {
        if (size_t(a.bufferView) >= model.bufferViews.size())
            return out;
        int stride = a.ByteStride(model.bufferViews[size_t(a.bufferView)]);
        if (stride <= 0)
            return out;
        out.values = plain_span_of(model, a.bufferView, a.byteOffset, size_t(stride), element, a.count);
        if (!out.values.begin)
            return out;
    }
    if (a.sparse.isSparse)
    {
        int size = tinygltf::GetComponentSizeInBytes(uint32_t(a.sparse.indices.componentType));
        if (size < 1 || a.sparse.count < 1)
            return out;
        out.sparse_count = size_t(a.sparse.count);
        out.sparse_component = a.sparse.indices.componentType;
        out.sparse_indices = plain_span_of(model, a.sparse.indices.bufferView, size_t(a.sparse.indices.byteOffset),
                                           size_t(size), size_t(size), out.sparse_count);
        out.sparse_values = plain_span_of(model, a.sparse.values.bufferView, size_t(a.sparse.values.byteOffset),
                                          element, element, out.sparse_count);
        if (!out.sparse_indices.begin || !out.sparse_values.begin)
            return out;
    }
    out.width = width;
    out.component = a.componentType;
    out.normalized = a.normalized;
    out.count = a.count;
    return out;
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

// The element k < count: of the sparse ones if it is there, which stand in ascending order.
const unsigned char* element_at(const span& s, size_t k)
{
    static const unsigned char zero[16] = {0};
    size_t low = 0, high = s.sparse_count;
    while (low < high)
    {
        size_t middle = (low + high) / 2;
        span indices = {};
        indices.component = s.sparse_component;
        uint32_t at = 0;
        if (!read_integer(indices, s.sparse_indices.begin + middle * s.sparse_indices.stride, &at))
            break;
        if (at == k)
            return s.sparse_values.begin + middle * s.sparse_values.stride;
        if (at < k)
            low = middle + 1;
        else
            high = middle;
    }
    return s.values.begin ? s.values.begin + k * s.values.stride : zero;
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

ty_gltf_primitive ty_gltf_get_primitive(const ty_gltf* gltf, int mesh, int primitive)
{
    const tinygltf::Primitive& p = gltf->model.meshes[size_t(mesh)].primitives[size_t(primitive)];
    return {p.mode < 0 ? TINYGLTF_MODE_TRIANGLES : p.mode, p.material};
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
    return ty_gltf_read_elements(gltf, accessor, nullptr, ty_gltf_accessor_count(gltf, accessor), out);
}

bool ty_gltf_read_elements(const ty_gltf* gltf, int accessor, const uint32_t* which, uint32_t count, float* out)
{
    span s = span_of(gltf, accessor);
    if (s.count == 0)
        return false;
    for (size_t k = 0; k < count; k++)
    {
        size_t index = which ? which[k] : k;
        if (index >= s.count)
            return false;
        const unsigned char* at = element_at(s, index);
        for (int i = 0; i < s.width; i++)
            *out++ = read_float(s, at, i);
    }
    return true;
}

bool ty_gltf_read_integers(const ty_gltf* gltf, int accessor, uint32_t* out)
{
    span s = span_of(gltf, accessor);
    if (s.count == 0 || s.width != 1)
        return false;
    for (size_t k = 0; k < s.count; k++)
        if (!read_integer(s, element_at(s, k), &out[k]))
            return false;
    return true;
}
