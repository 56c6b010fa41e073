// The OpenMesh bridge: see mesh.h. A mesh is cut into a surface first (Gueziec, Taubin, Lazarus & Horn, "Converting sets of
// polygons to manifold surfaces by cutting and stitching", 1998), so that OpenMesh's half-edges hold every polygon.
// SPDX-License-Identifier: MIT
// Invariant: corner c, polygon p and their order are the input's throughout; face handle p is polygon p.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized" // OpenMesh copies vectors before their first value is set
#endif
#include "mesh.h"

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/IO/reader/STLReader.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <istream>
#include <new>
#include <streambuf>
#include <vector>

namespace {

using index_list = std::vector<uint32_t>;

const uint32_t NONE = UINT32_MAX;
const double CREASE_COSINE = 0.8660254037844387; // of 30 degrees
const uint32_t FAN_MOST = 1024; // corners at one vertex: OpenMesh searches all of them for each new edge

struct surface_traits : OpenMesh::DefaultTraits {
    typedef OpenMesh::Vec3d Point;
    typedef OpenMesh::Vec3d Normal;
    VertexAttributes(OpenMesh::Attributes::None);
    HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
    EdgeAttributes(OpenMesh::Attributes::None);
    FaceAttributes(OpenMesh::Attributes::Normal);
};
typedef OpenMesh::PolyMesh_ArrayKernelT<surface_traits> surface;

// OpenMesh tells std::cerr what it refuses; the bridge finds its own answer to that.
void silence_openmesh()
{
    static const bool is_silent = (omerr().disable(), true);
    static_cast<void>(is_silent);
}

struct repair {
    const mesh_input *in;
    uint32_t corner_count;
    index_list polygon_of;  // a corner
    index_list place_of;    // a corner's welded position: the first vertex there
    std::vector<char> is_apart; // a polygon
    index_list mate_of;     // the corner whose edge runs back along this corner's edge
    index_list vertex_of;   // a corner's vertex of the cut surface
    index_list place_of_vertex;
    surface mesh;
    std::vector<OpenMesh::HalfedgeHandle> halfedge_of; // a corner: to the next corner
    index_list corner_of;   // a halfedge
    uint32_t apart_polygons = 0, cut_vertices = 0;

    uint32_t next(uint32_t corner) const
    {
        const uint32_t p = polygon_of[corner];
        return corner + 1 < in->polygon_first[p + 1] ? corner + 1 : in->polygon_first[p];
    }
    uint32_t previous(uint32_t corner) const
    {
        const uint32_t p = polygon_of[corner];
        return corner > in->polygon_first[p] ? corner - 1 : in->polygon_first[p + 1] - 1;
    }
    OpenMesh::Vec3d point(uint32_t place) const
    {
        const double *p = in->positions + 3 * static_cast<size_t>(place);
        return OpenMesh::Vec3d(p[0] + 0.0, p[1] + 0.0, p[2] + 0.0); // -0 becomes 0
    }
};

// ---- Welding ----

uint64_t mix(uint64_t x)
{
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

uint64_t hash_of(const OpenMesh::Vec3d &p)
{
    uint64_t bits[3], hash = 0;
    std::memcpy(bits, p.data(), sizeof bits);
    for (const uint64_t b : bits) hash = mix(hash + b + 0x9e3779b97f4a7c15u);
    return hash;
}

index_list weld(const repair &r)
{
    size_t size = 64;
    while (size < size_t{2} * r.in->position_count) size *= 2;
    index_list slots(size, NONE), first(r.in->position_count);
    for (uint32_t v = 0; v < r.in->position_count; ++v) {
        const OpenMesh::Vec3d p = r.point(v);
        size_t at = hash_of(p) & (size - 1);
        while (slots[at] != NONE && r.point(slots[at]) != p) at = (at + 1) & (size - 1);
        if (slots[at] == NONE) slots[at] = v;
        first[v] = slots[at];
    }
    return first;
}

void open_corners(repair &r)
{
    const mesh_input &in = *r.in;
    const index_list first = weld(r);
    index_list seen(in.position_count, NONE);
    r.polygon_of.resize(r.corner_count);
    r.place_of.resize(r.corner_count);
    r.is_apart.assign(in.polygon_count, 0);
    for (uint32_t p = 0; p < in.polygon_count; ++p)
        for (uint32_t c = in.polygon_first[p]; c < in.polygon_first[p + 1]; ++c) {
            const uint32_t place = first[in.corners[c]];
            r.polygon_of[c] = p;
            r.place_of[c] = place;
            if (seen[place] == p) r.is_apart[p] = 1; // no half-edge structure holds a face twice at one vertex
            seen[place] = p;
        }
}

// ---- Cutting ----

struct edge {
    uint32_t to; // the larger place; the smaller one is the bucket
    uint32_t corner;
    bool operator<(const edge &other) const { return to != other.to ? to < other.to : corner < other.corner; }
};

// Pairs the k-th use of an edge in one direction with the k-th in the other; what is over stays a boundary.
void pair_edges(repair &r, const edge *first, const edge *last)
{
    const edge *up = first, *down = first;
    const auto is_up = [&r](const edge *e) { return r.place_of[e->corner] < e->to; };
    for (;; ++up, ++down) {
        while (up < last && !is_up(up)) ++up;
        while (down < last && is_up(down)) ++down;
        if (up >= last || down >= last) return;
        r.mate_of[up->corner] = down->corner;
        r.mate_of[down->corner] = up->corner;
    }
}

void find_mates(repair &r)
{
    std::vector<size_t> bucket(size_t{r.in->position_count} + 1, 0);
    const auto smaller_end = [&r](uint32_t c) { return std::min(r.place_of[c], r.place_of[r.next(c)]); };
    r.mate_of.assign(r.corner_count, NONE);
    for (uint32_t c = 0; c < r.corner_count; ++c)
        if (!r.is_apart[r.polygon_of[c]]) bucket[smaller_end(c) + 1]++;
    for (size_t i = 1; i < bucket.size(); ++i) bucket[i] += bucket[i - 1];
    std::vector<edge> edges(bucket.back());
    std::vector<size_t> place(bucket.begin(), bucket.end() - 1);
    for (uint32_t c = 0; c < r.corner_count; ++c)
        if (!r.is_apart[r.polygon_of[c]]) edges[place[smaller_end(c)]++] = edge{std::max(r.place_of[c], r.place_of[r.next(c)]), c};
    for (size_t b = 0; b + 1 < bucket.size(); ++b) {
        edge *first = edges.data() + bucket[b], *const last = edges.data() + bucket[b + 1];
        std::sort(first, last);
        while (first < last) {
            edge *group = first;
            while (first < last && first->to == group->to) ++first;
            pair_edges(r, group, first);
        }
    }
}

// The next corner round the same vertex, over the edge that leaves or that enters it.
uint32_t turn_out(const repair &r, uint32_t corner)
{
    return r.mate_of[corner] == NONE ? NONE : r.next(r.mate_of[corner]);
}

uint32_t turn_in(const repair &r, uint32_t corner)
{
    return r.mate_of[r.previous(corner)];
}

// A fan of corners that hang together gets one vertex, or several where it is too long for OpenMesh.
void number_fan(repair &r, uint32_t corner)
{
    uint32_t start = corner;
    for (uint32_t c = turn_in(r, corner); c != NONE && c != corner; c = turn_in(r, c)) start = c;
    uint32_t length = 0;
    for (uint32_t c = start; c != NONE && r.vertex_of[c] == NONE; c = turn_out(r, c), ++length) {
        if (length % FAN_MOST == 0) r.place_of_vertex.push_back(r.place_of[c]);
        r.vertex_of[c] = static_cast<uint32_t>(r.place_of_vertex.size() - 1);
    }
}

void cut_surface(repair &r)
{
    find_mates(r);
    index_list fans(r.in->position_count, 0);
    r.vertex_of.assign(r.corner_count, NONE);
    for (uint32_t c = 0; c < r.corner_count; ++c)
        if (r.vertex_of[c] == NONE) number_fan(r, c);
    for (const uint32_t place : r.place_of_vertex)
        if (fans[place]++) r.cut_vertices++;
}

// ---- OpenMesh ----

OpenMesh::VertexHandle handle(uint32_t index)
{
    return OpenMesh::VertexHandle(static_cast<int>(index));
}

// Two faces that share two edges between the same vertices can't both hang on them: the later one gets its own.
void set_apart(repair &r, uint32_t p, std::vector<OpenMesh::VertexHandle> &loop)
{
    for (uint32_t c = r.in->polygon_first[p]; c < r.in->polygon_first[p + 1]; ++c) {
        r.place_of_vertex.push_back(r.place_of[c]);
        r.vertex_of[c] = static_cast<uint32_t>(r.place_of_vertex.size() - 1);
        loop[c - r.in->polygon_first[p]] = r.mesh.add_vertex(r.point(r.place_of[c]));
    }
    r.is_apart[p] = 1;
    if (!r.mesh.add_face(loop).is_valid()) throw std::bad_alloc(); // vertices of its own: only memory can be short
}

void build_halfedges(repair &r)
{
    std::vector<OpenMesh::VertexHandle> loop;
    const size_t vertices = r.place_of_vertex.size();
    size_t edges = 0;
    for (uint32_t c = 0; c < r.corner_count; ++c) edges += r.mate_of[c] == NONE || r.mate_of[c] > c;
    r.mesh.reserve(vertices, edges, r.in->polygon_count);
    for (const uint32_t place : r.place_of_vertex) r.mesh.add_vertex(r.point(place));
    for (uint32_t p = 0; p < r.in->polygon_count; ++p) {
        loop.clear();
        for (uint32_t c = r.in->polygon_first[p]; c < r.in->polygon_first[p + 1]; ++c) loop.push_back(handle(r.vertex_of[c]));
        if (!r.mesh.add_face(loop).is_valid()) set_apart(r, p, loop);
        r.apart_polygons += r.is_apart[p] != 0;
    }
    r.cut_vertices += static_cast<uint32_t>(r.place_of_vertex.size() - vertices);
}

void index_halfedges(repair &r)
{
    r.halfedge_of.resize(r.corner_count);
    r.corner_of.assign(r.mesh.n_halfedges(), NONE);
    for (uint32_t p = 0; p < r.in->polygon_count; ++p) {
        const uint32_t first = r.in->polygon_first[p];
        OpenMesh::HalfedgeHandle h = r.mesh.halfedge_handle(OpenMesh::FaceHandle(static_cast<int>(p)));
        while (r.mesh.from_vertex_handle(h) != handle(r.vertex_of[first])) h = r.mesh.next_halfedge_handle(h);
        for (uint32_t c = first; c < r.in->polygon_first[p + 1]; ++c, h = r.mesh.next_halfedge_handle(h)) {
            r.halfedge_of[c] = h;
            r.corner_of[static_cast<size_t>(h.idx())] = c;
        }
    }
}

// ---- Normals ----

// Newell's: right for polygons that aren't flat or convex too. Zero for one without area.
void find_face_normals(repair &r)
{
    for (uint32_t p = 0; p < r.in->polygon_count; ++p) {
        const uint32_t first = r.in->polygon_first[p];
        const OpenMesh::Vec3d origin = r.point(r.place_of[first]);
        OpenMesh::Vec3d sum(0, 0, 0);
        for (uint32_t c = first; c < r.in->polygon_first[p + 1]; ++c)
            sum += OpenMesh::cross(r.point(r.place_of[c]) - origin, r.point(r.place_of[r.next(c)]) - origin);
        const double length = sum.norm();
        r.mesh.set_normal(OpenMesh::FaceHandle(static_cast<int>(p)), length > 0 ? sum / length : OpenMesh::Vec3d(0, 0, 0));
    }
}

// Max, "Weights for computing vertex normals from facet normals" (1999): exact on spheres, no angles.
double corner_weight(const repair &r, uint32_t c)
{
    const OpenMesh::Vec3d at = r.point(r.place_of[c]);
    const OpenMesh::Vec3d a = r.point(r.place_of[r.next(c)]) - at, b = r.point(r.place_of[r.previous(c)]) - at;
    const double lengths = a.sqrnorm() * b.sqrnorm();
    return lengths > 0 ? OpenMesh::cross(a, b).norm() / lengths : 0;
}

// The corner on the other side of a halfedge's edge that stands at the same vertex, where the surface is smooth; else NONE.
uint32_t smooth_turn(const repair &r, OpenMesh::HalfedgeHandle over, OpenMesh::HalfedgeHandle to)
{
    const OpenMesh::FaceHandle a = r.mesh.face_handle(over), b = r.mesh.face_handle(r.mesh.opposite_halfedge_handle(over));
    if (!a.is_valid() || !b.is_valid() || OpenMesh::dot(r.mesh.normal(a), r.mesh.normal(b)) < CREASE_COSINE) return NONE;
    return r.corner_of[static_cast<size_t>(to.idx())];
}

uint32_t smooth_out(const repair &r, uint32_t c)
{
    const OpenMesh::HalfedgeHandle h = r.halfedge_of[c];
    return smooth_turn(r, h, r.mesh.next_halfedge_handle(r.mesh.opposite_halfedge_handle(h)));
}

uint32_t smooth_in(const repair &r, uint32_t c)
{
    const OpenMesh::HalfedgeHandle h = r.mesh.prev_halfedge_handle(r.halfedge_of[c]);
    return smooth_turn(r, h, r.mesh.opposite_halfedge_handle(h));
}

struct shading {
    index_list vertex_of; // a corner: output vertex
    index_list places;    // an output vertex
    std::vector<OpenMesh::Vec3d> normals;
};

// Corners of one vertex between two creases share an output vertex and its normal.
void shade_sector(const repair &r, shading &s, uint32_t corner)
{
    uint32_t start = corner;
    for (uint32_t c = smooth_in(r, corner); c != NONE && c != corner; c = smooth_in(r, c)) start = c;
    OpenMesh::Vec3d sum(0, 0, 0);
    for (uint32_t c = start; c != NONE && s.vertex_of[c] == NONE; c = smooth_out(r, c)) {
        s.vertex_of[c] = static_cast<uint32_t>(s.places.size());
        sum += r.mesh.normal(OpenMesh::FaceHandle(static_cast<int>(r.polygon_of[c]))) * corner_weight(r, c);
    }
    const double length = sum.norm();
    s.places.push_back(r.place_of[corner]);
    s.normals.push_back(length > 0 && std::isfinite(length) ? sum / length : OpenMesh::Vec3d(0, 0, 0));
}

shading shade(repair &r)
{
    shading s;
    find_face_normals(r);
    s.vertex_of.assign(r.corner_count, NONE);
    for (uint32_t c = 0; c < r.corner_count; ++c)
        if (s.vertex_of[c] == NONE) shade_sector(r, s, c);
    return s;
}

// ---- Out ----

template <class T> T *take(arena *memory, size_t count)
{
    void *block = arena_push(memory, count, sizeof(T));
    if (!block) throw std::bad_alloc();
    return static_cast<T *>(block);
}

void write_output(const repair &r, const shading &s, arena *memory, mesh_output *out)
{
    mesh_output o = {};
    o.position_count = static_cast<uint32_t>(s.places.size());
    o.cut_vertices = r.cut_vertices;
    o.apart_polygons = r.apart_polygons;
    o.positions = take<double>(memory, 3 * s.places.size());
    o.normals = take<float>(memory, 3 * s.places.size());
    o.corners = take<uint32_t>(memory, r.corner_count);
    o.corner_neighbours = take<uint32_t>(memory, r.corner_count);
    for (size_t v = 0; v < s.places.size(); ++v) {
        const OpenMesh::Vec3d p = r.point(s.places[v]);
        for (size_t k = 0; k < 3; ++k) {
            o.positions[3 * v + k] = p[k];
            o.normals[3 * v + k] = static_cast<float>(s.normals[v][k]);
        }
    }
    for (uint32_t c = 0; c < r.corner_count; ++c) {
        const OpenMesh::FaceHandle f = r.mesh.face_handle(r.mesh.opposite_halfedge_handle(r.halfedge_of[c]));
        o.corners[c] = s.vertex_of[c];
        o.corner_neighbours[c] = f.is_valid() ? static_cast<uint32_t>(f.idx()) : MESH_NO_NEIGHBOUR;
        o.boundary_edges += !f.is_valid();
    }
    *out = o;
}

void repair_mesh(const mesh_input *in, arena *memory, mesh_output *out)
{
    silence_openmesh();
    repair r;
    r.in = in;
    r.corner_count = in->polygon_first[in->polygon_count];
    open_corners(r);
    cut_surface(r);
    build_halfedges(r);
    index_halfedges(r);
    write_output(r, shade(r), memory, out);
}

// ---- .stl ----

class memory_buffer : public std::streambuf {
public:
    memory_buffer(const char *bytes, size_t size)
    {
        char *first = const_cast<char *>(bytes); // setg wants it; nothing is written
        setg(first, first, first + size);
    }
};

// Takes vertices and faces as the reader gives them, without a mesh in between that would refuse some.
class triangle_list : public OpenMesh::IO::BaseImporter {
public:
    std::vector<OpenMesh::Vec3f> points;
    std::vector<int> corners;

    OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3f &p) override
    {
        points.push_back(p);
        return OpenMesh::VertexHandle(static_cast<int>(points.size() - 1));
    }
    OpenMesh::VertexHandle add_vertex() override { return add_vertex(OpenMesh::Vec3f(0, 0, 0)); }
    OpenMesh::FaceHandle add_face(const VHandles &loop) override
    {
        for (const OpenMesh::VertexHandle v : loop) corners.push_back(v.idx());
        return OpenMesh::FaceHandle(static_cast<int>(corners.size() / 3 - 1));
    }
    size_t n_vertices() const override { return points.size(); }
    size_t n_faces() const override { return corners.size() / 3; }
    size_t n_edges() const override { return 0; }

    // No .stl has any of these.
    OpenMesh::HalfedgeHandle add_edge(OpenMesh::VertexHandle, OpenMesh::VertexHandle) override { return OpenMesh::HalfedgeHandle(); }
    OpenMesh::FaceHandle add_face(OpenMesh::HalfedgeHandle) override { return OpenMesh::FaceHandle(); }
    void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle, const std::vector<OpenMesh::Vec2f> &) override {}
    void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle, const std::vector<OpenMesh::Vec3f> &) override {}
    void set_face_texindex(OpenMesh::FaceHandle, int) override {}
    void set_point(OpenMesh::VertexHandle, const OpenMesh::Vec3f &) override {}
    void set_halfedge(OpenMesh::VertexHandle, OpenMesh::HalfedgeHandle) override {}
    void set_normal(OpenMesh::VertexHandle, const OpenMesh::Vec3f &) override {}
    void set_normal(OpenMesh::VertexHandle, const OpenMesh::Vec3d &) override {}
    void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec3uc &) override {}
    void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec4uc &) override {}
    void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec3f &) override {}
    void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec4f &) override {}
    void set_texcoord(OpenMesh::VertexHandle, const OpenMesh::Vec2f &) override {}
    void set_texcoord(OpenMesh::HalfedgeHandle, const OpenMesh::Vec2f &) override {}
    void set_texcoord(OpenMesh::VertexHandle, const OpenMesh::Vec3f &) override {}
    void set_texcoord(OpenMesh::HalfedgeHandle, const OpenMesh::Vec3f &) override {}
    void set_status(OpenMesh::VertexHandle, const OpenMesh::Attributes::StatusInfo &) override {}
    void set_status(OpenMesh::HalfedgeHandle, const OpenMesh::Attributes::StatusInfo &) override {}
    void set_status(OpenMesh::EdgeHandle, const OpenMesh::Attributes::StatusInfo &) override {}
    void set_status(OpenMesh::FaceHandle, const OpenMesh::Attributes::StatusInfo &) override {}
    void set_next(OpenMesh::HalfedgeHandle, OpenMesh::HalfedgeHandle) override {}
    void set_face(OpenMesh::HalfedgeHandle, OpenMesh::FaceHandle) override {}
    void request_face_texcoords2D() override {}
    void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec3uc &) override {}
    void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec4uc &) override {}
    void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec3f &) override {}
    void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec4f &) override {}
    void set_normal(OpenMesh::FaceHandle, const OpenMesh::Vec3f &) override {}
    void set_normal(OpenMesh::FaceHandle, const OpenMesh::Vec3d &) override {}
    void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec3uc &) override {}
    void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec4uc &) override {}
    void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec3f &) override {}
    void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec4f &) override {}
    void add_texture_information(int, std::string) override {}
};

result read_stl(const char *bytes, size_t size, arena *memory, double **out_triangles, uint32_t *out_count)
{
    silence_openmesh();
    memory_buffer buffer(bytes, size);
    std::istream stream(&buffer);
    stream.exceptions(std::ios::badbit); // else a stream turns std::bad_alloc into a short file
    triangle_list list;
    OpenMesh::IO::Options options;
    options += OpenMesh::IO::Options::Binary;
    if (!OpenMesh::IO::STLReader().read(stream, list, options)) return RESULT_BAD_INPUT;
    double *triangles = take<double>(memory, 3 * list.corners.size());
    for (size_t c = 0; c < list.corners.size(); ++c)
        for (size_t k = 0; k < 3; ++k) triangles[3 * c + k] = static_cast<double>(list.points[static_cast<size_t>(list.corners[c])][k]);
    *out_triangles = triangles;
    *out_count = static_cast<uint32_t>(list.corners.size() / 3);
    return RESULT_OK;
}

} // namespace

extern "C" result mesh_repair(const mesh_input *in, arena *memory, mesh_output *out)
{
    try {
        repair_mesh(in, memory, out);
        return RESULT_OK;
    } catch (...) { // std::bad_alloc, or std::length_error of a vector: memory in both cases
        return RESULT_NO_MEMORY;
    }
}

extern "C" result mesh_read_stl(const char *path, const char *bytes, size_t size, arena *memory, report *r, double **out_triangles,
                                uint32_t *out_count)
{
    try {
        const result done = read_stl(bytes, size, memory, out_triangles, out_count);
        return done == RESULT_OK ? done : report_error(r, path, 0, "OpenMesh cannot read it; is this an .stl file?");
    } catch (...) {
        return report_no_memory(r, path);
    }
}
