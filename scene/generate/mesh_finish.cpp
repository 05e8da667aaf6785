// What is done to a whole mesh: refining, normals, conversion to a Geometry.
#include "scene/generate/mesh_maker.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <queue>
#include <unordered_map>

namespace lodestone::generate {

namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edgeOf(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

// Splits edges, keeping for every edge the triangles that have it.
class Refiner {
public:
    explicit Refiner(Mesh& mesh) : mesh_(mesh) {
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k)
                addEdge(edgeOf(mesh_.triangles[t][k], mesh_.triangles[t][(k + 1) % 3]), t);
    }

    void run(std::size_t triangle_count) {
        while (mesh_.triangles.size() < triangle_count && !queue_.empty()) {
            const Edge edge = queue_.top().edge;
            queue_.pop();
            const auto found = faces_.find(edge);
            if (found == faces_.end() ||
                mesh_.triangles.size() + found->second.size() > triangle_count)
                continue;
            const std::vector<std::uint32_t> around = found->second;
            faces_.erase(found);
            split(edge, around);
        }
    }

private:
    struct Entry {
        double length2;
        Edge edge;

        bool operator<(const Entry& other) const {
            return length2 != other.length2 ? length2 < other.length2 : edge > other.edge;
        }
    };

    void addEdge(const Edge& edge, std::uint32_t triangle) {
        std::vector<std::uint32_t>& around = faces_[edge];
        around.push_back(triangle);
        if (around.size() == 1) {
            const glm::dvec3 d = mesh_.positions[edge.first] - mesh_.positions[edge.second];
            queue_.push({glm::dot(d, d), edge});
        }
    }

    void split(const Edge& edge, const std::vector<std::uint32_t>& around) {
        const std::uint32_t middle =
            mesh_.addVertex((mesh_.positions[edge.first] + mesh_.positions[edge.second]) * 0.5);
        for (const std::uint32_t t : around) {
            Triangle& old = mesh_.triangles[t];
            std::size_t k = 0;
            while (edgeOf(old[k], old[(k + 1) % 3]) != edge)
                ++k;
            const std::uint32_t b = old[(k + 1) % 3];
            const std::uint32_t apex = old[(k + 2) % 3];
            const std::uint32_t a = old[k];
            old[(k + 1) % 3] = middle;
            const auto added = static_cast<std::uint32_t>(mesh_.triangles.size());
            mesh_.triangles.push_back({middle, b, apex});
            std::ranges::replace(faces_[edgeOf(b, apex)], t, added);
            addEdge(edgeOf(a, middle), t);
            addEdge(edgeOf(middle, b), added);
            addEdge(edgeOf(middle, apex), t);
            addEdge(edgeOf(middle, apex), added);
        }
    }

    struct EdgeHash {
        std::size_t operator()(const Edge& e) const {
            return (static_cast<std::size_t>(e.first) << 32 | e.second) * 0x9E3779B97F4A7C15ull >>
                   7;
        }
    };

    Mesh& mesh_;
    std::unordered_map<Edge, std::vector<std::uint32_t>, EdgeHash> faces_;
    std::priority_queue<Entry> queue_;
};

glm::dvec3 faceNormal(const Mesh& mesh, const Triangle& t) {
    const glm::dvec3& a = mesh.positions[t[0]];
    return glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a); // length: twice the area
}

// Corners of one vertex that share a normal.
class CornerGroups {
public:
    CornerGroups(const Mesh& mesh, double crease_angle)
        : mesh_(mesh), cos_crease_(cosine(crease_angle)), group_(mesh.triangles.size() * 3) {
        for (const Triangle& t : mesh.triangles)
            normals_.push_back(faceNormal(mesh, t));
        std::vector<std::vector<std::uint32_t>> corners(mesh.positions.size());
        for (std::uint32_t c = 0; c < group_.size(); ++c) {
            group_[c] = c;
            corners[vertexOf(c)].push_back(c);
        }
        for (const std::vector<std::uint32_t>& around : corners)
            joinAround(around);
    }

    // The smallest corner of the same group.
    std::uint32_t find(std::uint32_t c) const {
        while (group_[c] != c)
            c = group_[c];
        return c;
    }

    std::uint32_t vertexOf(std::uint32_t c) const { return mesh_.triangles[c / 3][c % 3]; }

    const glm::dvec3& normalOf(std::uint32_t c) const { return normals_[c / 3]; }

private:
    void joinAround(const std::vector<std::uint32_t>& around) {
        for (const std::uint32_t a : around)
            for (const std::uint32_t b : around)
                if (a < b && shareEdge(a, b) && smooth(a, b)) {
                    const std::uint32_t ra = find(a);
                    const std::uint32_t rb = find(b);
                    group_[std::max(ra, rb)] = std::min(ra, rb);
                }
    }

    bool shareEdge(std::uint32_t a, std::uint32_t b) const {
        const Triangle& t = mesh_.triangles[a / 3];
        const Triangle& u = mesh_.triangles[b / 3];
        return t[(a + 1) % 3] == u[(b + 2) % 3] || t[(a + 2) % 3] == u[(b + 1) % 3];
    }

    bool smooth(std::uint32_t a, std::uint32_t b) const {
        const glm::dvec3& na = normals_[a / 3];
        const glm::dvec3& nb = normals_[b / 3];
        return glm::dot(na, nb) > cos_crease_ * glm::length(na) * glm::length(nb);
    }

    const Mesh& mesh_;
    double cos_crease_;
    std::vector<glm::dvec3> normals_;  // [triangles]
    std::vector<std::uint32_t> group_; // [triangles * 3]
};

Attribute normalAttribute(const std::vector<glm::dvec3>& sums) {
    std::vector<glm::vec3> normals;
    normals.reserve(sums.size());
    for (const glm::dvec3& sum : sums)
        normals.emplace_back(glm::normalize(sum));
    Attribute attribute;
    attribute.semantic = "NORMAL";
    attribute.bytes.resize(normals.size() * sizeof(glm::vec3));
    std::memcpy(attribute.bytes.data(), normals.data(), attribute.bytes.size());
    return attribute;
}

} // namespace

void refineTo(Mesh& mesh, std::size_t triangle_count) {
    Refiner(mesh).run(triangle_count);
}

Mesh ball(int level) {
    Mesh mesh;
    const double g = (1.0 + std::sqrt(5.0)) / 2.0;
    for (const glm::dvec3& p : {glm::dvec3(-1, g, 0),
                                glm::dvec3(1, g, 0),
                                glm::dvec3(-1, -g, 0),
                                glm::dvec3(1, -g, 0),
                                glm::dvec3(0, -1, g),
                                glm::dvec3(0, 1, g),
                                glm::dvec3(0, -1, -g),
                                glm::dvec3(0, 1, -g),
                                glm::dvec3(g, 0, -1),
                                glm::dvec3(g, 0, 1),
                                glm::dvec3(-g, 0, -1),
                                glm::dvec3(-g, 0, 1)})
        mesh.addVertex(glm::normalize(p));
    mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int l = 0; l < level; ++l) {
        std::map<Edge, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, added] = middles.try_emplace(edgeOf(a, b), 0);
            if (added)
                at->second = mesh.addVertex(glm::normalize(mesh.positions[a] + mesh.positions[b]));
            return at->second;
        };
        std::vector<Triangle> finer;
        for (const Triangle& t : mesh.triangles) {
            const std::uint32_t a = middle(t[0], t[1]);
            const std::uint32_t b = middle(t[1], t[2]);
            const std::uint32_t c = middle(t[2], t[0]);
            finer.insert(finer.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
        }
        mesh.triangles = std::move(finer);
    }
    return mesh;
}

std::vector<glm::dvec3> vertexNormals(const Mesh& mesh) {
    std::vector<glm::dvec3> normals(mesh.positions.size(), glm::dvec3(0.0));
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t)
            normals[v] += faceNormal(mesh, t);
    for (glm::dvec3& n : normals)
        n = glm::normalize(n);
    return normals;
}

GeometryPtr makeGeometry(const Mesh& mesh, double crease_angle) {
    const CornerGroups groups(mesh, crease_angle);
    auto geometry = std::make_shared<Geometry>();
    std::vector<glm::dvec3> sums;
    std::vector<std::uint32_t> vertex_of(mesh.triangles.size() * 3);
    for (std::uint32_t c = 0; c < vertex_of.size(); ++c) {
        const std::uint32_t root = groups.find(c);
        if (root == c) { // the smallest corner comes first
            vertex_of[c] = static_cast<std::uint32_t>(sums.size());
            geometry->positions.emplace_back(mesh.positions[groups.vertexOf(c)]);
            sums.emplace_back(0.0);
        }
        vertex_of[c] = vertex_of[root];
        sums[vertex_of[c]] += groups.normalOf(c);
        geometry->indices.push_back(vertex_of[c]);
    }
    geometry->attributes.push_back(normalAttribute(sums));
    return geometry;
}

} // namespace lodestone::generate
