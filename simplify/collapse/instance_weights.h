#pragma once
// How much a submesh's faces and borders count, summed over its instances (Azim et al. 2015, eq.
// 5), in closed form: O(groups) a direction instead of O(instances) a face.
//
// For a linear part M with G = M^T M, cofactor matrix C: the quadric of an instanced face pulled
// back to the submesh is A * w(n) * p p^T with w(n) = det(M)^2 / |C n| = det(G) / sqrt(n^T cof(G)
// n), and a border constraint through edge e becomes q q^T with q along e x (G^-1 n), q^T G^-1 q =
// 1, weighted by e^T G e. Both depend on M through G alone.
#include "scene/scene.h"

#include <array>

namespace lodestone {

class InstanceWeights {
public:
    // Weights of a single untransformed instance: 1 everywhere.
    InstanceWeights();
    // Sum over these linear parts. Singular ones count 0 on faces.
    explicit InstanceWeights(std::span<const glm::dmat3> linear_parts);

    // True where all instances are similarities: then weights are scale() whatever the direction.
    bool uniform() const { return groups_.empty(); }

    // What the weights below are relative to: the sum of s^4 for similarities of scale s, else the
    // sum of (trace(G) / 3)^2. 0 only if every linear part is 0.
    double scale() const { return scale_; }

    // W(n) / scale() of a face with unit normal n. Up to 64 groups exact, else tabulated (1 %).
    double face(const glm::dvec3& normal) const;

    // The border constraint of edge vector e on a face with unit normal n: planes through the edge,
    // unit in the submesh's space, with weights over scale(), by squared length (or length). Above
    // 64 groups within 1 % by squared length, within a quarter by length.
    struct Plane {
        glm::dvec3 normal{0.0};
        double weight = 0.0;
    };

    void border(const glm::dvec3& edge,
                const glm::dvec3& normal,
                bool by_length,
                std::vector<Plane>& out) const;

    // Sum of C^T C over scale(): v^T area() v is what a vector area v counts, squared, over all
    // instances (Lindstrom and Turk's border term).
    glm::dmat3 area() const;

    // The largest factor by which an instance stretches a length.
    double maxStretch() const { return max_stretch_; }

private:
    struct Group {
        glm::dmat3 gram{1.0};      // G
        glm::dmat3 cofactor{1.0};  // cof(G)
        double determinant = 1.0;  // det(G)
        double count = 1.0;        // instances
        double length_count = 1.0; // the same for borders by length
    };

    // Relative to scale().
    struct Directed {
        double face = 0.0;    // W(n)
        glm::dmat3 pull{0.0}; // sum of (cof(G) n)(cof(G) n)^T / |C n|^2: all that a border by
                              // squared length needs beside its edge
    };

    void tabulate();
    void cluster();
    Directed exact(const glm::dvec3& normal) const;
    Directed lookUp(const glm::dvec3& normal) const;

    std::vector<Group> groups_;   // empty: uniform
    std::vector<Directed> table_; // over directions, where there were too many groups
    double scale_ = 0.0;
    double length_ratio_ = 1.0; // uniform(): sum of s^3 over sum of s^4, for borders by length
    double max_stretch_ = 1.0;
};

} // namespace lodestone
