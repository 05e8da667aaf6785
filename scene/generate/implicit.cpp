#include "scene/generate/implicit.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace lodestone::generate {

namespace {

class Polygonizer {
public:
    Polygonizer(const Field& field, const Grid& grid)
        : grid_(grid), nodes_(grid.cells + 1),
          values_(static_cast<std::size_t>(nodes_.x) * static_cast<std::size_t>(nodes_.y) *
                  static_cast<std::size_t>(nodes_.z)),
          vertex_at_(values_.size() * 8, kNone) {
        tbb::parallel_for(0, nodes_.z, [&](int z) {
            for (int y = 0; y < nodes_.y; ++y)
                for (int x = 0; x < nodes_.x; ++x)
                    values_[nodeIndex({x, y, z})] = field(position({x, y, z}));
        });
    }

    Mesh run() {
        for (int z = 0; z < grid_.cells.z; ++z)
            for (int y = 0; y < grid_.cells.y; ++y)
                for (int x = 0; x < grid_.cells.x; ++x)
                    if (crossed({x, y, z}))
                        marchCell({x, y, z});
        return std::move(mesh_);
    }

private:
    std::size_t nodeIndex(const glm::ivec3& n) const {
        return (static_cast<std::size_t>(n.z) * static_cast<std::size_t>(nodes_.y) +
                static_cast<std::size_t>(n.y)) *
                   static_cast<std::size_t>(nodes_.x) +
               static_cast<std::size_t>(n.x);
    }

    glm::dvec3 position(const glm::ivec3& n) const {
        return grid_.min + glm::dvec3(n) * grid_.cell;
    }

    double value(const glm::ivec3& n) const { return values_[nodeIndex(n)]; }

    bool crossed(const glm::ivec3& cell) const {
        int inside = 0;
        for (int corner = 0; corner < 8; ++corner)
            inside += value(cell + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2)) < 0.0;
        return inside != 0 && inside != 8;
    }

    void marchCell(const glm::ivec3& cell) {
        constexpr int kOrders[6][3] = {
            {0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
        for (const auto& order : kOrders) {
            std::array<glm::ivec3, 4> corners{cell, cell, cell, cell};
            for (std::size_t step = 0; step < 3; ++step)
                for (std::size_t later = step + 1; later < 4; ++later)
                    corners[later][order[step]] += 1;
            marchTetrahedron(corners);
        }
    }

    // The vertex on the edge between two nodes, one of which is the other's lower neighbour.
    std::uint32_t vertexOn(glm::ivec3 a, glm::ivec3 b) {
        if (nodeIndex(b) < nodeIndex(a))
            std::swap(a, b);
        const glm::ivec3 d = b - a;
        std::uint32_t& vertex =
            vertex_at_[nodeIndex(a) * 8 + static_cast<std::size_t>(d.x + 2 * d.y + 4 * d.z)];
        if (vertex == kNone) {
            // Kept off the nodes, so that no two vertices coincide.
            const double t = std::clamp(value(a) / (value(a) - value(b)), 0.04, 0.96);
            vertex = mesh_.addVertex(position(a) + (position(b) - position(a)) * t);
        }
        return vertex;
    }

    void marchTetrahedron(const std::array<glm::ivec3, 4>& corners) {
        std::vector<glm::ivec3>& in = inside_;
        std::vector<glm::ivec3>& out = outside_;
        in.clear();
        out.clear();
        for (const glm::ivec3& c : corners)
            (value(c) < 0.0 ? in : out).push_back(c);
        if (in.empty() || out.empty())
            return;
        const glm::dvec3 outward = middle(out) - middle(in);
        if (in.size() == 2) {
            addFacing({vertexOn(in[0], out[0]), vertexOn(in[0], out[1]), vertexOn(in[1], out[1])},
                      outward);
            addFacing({vertexOn(in[0], out[0]), vertexOn(in[1], out[1]), vertexOn(in[1], out[0])},
                      outward);
            return;
        }
        const glm::ivec3 alone = in.size() == 1 ? in[0] : out[0];
        const std::vector<glm::ivec3>& others = in.size() == 1 ? out : in;
        addFacing(
            {vertexOn(alone, others[0]), vertexOn(alone, others[1]), vertexOn(alone, others[2])},
            outward);
    }

    glm::dvec3 middle(const std::vector<glm::ivec3>& nodes) const {
        glm::dvec3 sum(0.0);
        for (const glm::ivec3& n : nodes)
            sum += position(n);
        return sum / static_cast<double>(nodes.size());
    }

    void addFacing(const std::array<std::uint32_t, 3>& t, const glm::dvec3& outward) {
        const glm::dvec3& a = mesh_.positions[t[0]];
        const glm::dvec3 normal = glm::cross(mesh_.positions[t[1]] - a, mesh_.positions[t[2]] - a);
        glm::dot(normal, outward) > 0.0 ? mesh_.addTriangle(t[0], t[1], t[2])
                                        : mesh_.addTriangle(t[0], t[2], t[1]);
    }

    Grid grid_;
    glm::ivec3 nodes_;
    std::vector<double> values_;
    std::vector<std::uint32_t> vertex_at_; // [nodes * 8], by direction of the edge
    std::vector<glm::ivec3> inside_;
    std::vector<glm::ivec3> outside_;
    Mesh mesh_;
};

} // namespace

Mesh polygonize(const Field& field, const Grid& grid) {
    return Polygonizer(field, grid).run();
}

glm::dvec3 gradient(const Field& field, const glm::dvec3& p) {
    constexpr double kStep = 1e-4;
    glm::dvec3 g;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step(0.0);
        step[axis] = kStep;
        g[axis] = (field(p + step) - field(p - step)) / (2.0 * kStep);
    }
    return g;
}

void relax(Mesh& mesh, const Field& field, int rounds) {
    for (int round = 0; round < rounds; ++round) {
        std::vector<glm::dvec3> sum(mesh.positions.size(), glm::dvec3(0.0));
        std::vector<double> count(mesh.positions.size(), 0.0);
        for (const auto& t : mesh.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                sum[t[k]] += mesh.positions[t[(k + 1) % 3]];
                count[t[k]] += 1.0;
            }
        tbb::parallel_for(std::size_t{0}, mesh.positions.size(), [&](std::size_t v) {
            glm::dvec3& p = mesh.positions[v];
            const glm::dvec3 n = glm::normalize(gradient(field, p));
            const glm::dvec3 move = (sum[v] / count[v] - p) * 0.5;
            p += move - n * glm::dot(move, n);
            p -= n * field(p);
        });
    }
}

} // namespace lodestone::generate
