#pragma once
// House types: walls, a roof that fits them, and where their windows, doors and chimneys go.
#include "scene/generate/mesh_maker.h"

namespace lodestone::generate {

// Where a part goes in the house's frame: +z is the front, y = 0 the doorstep.
struct Fitting {
    glm::dvec3 position;
    double angle; // about y; 0 faces +z
};

struct HouseType {
    Mesh walls;
    Mesh roof;
    std::uint32_t wall_color;
    std::uint32_t roof_color;
    std::vector<Fitting> windows;
    std::vector<Fitting> doors;
    std::vector<Fitting> chimneys;
    bool shutters;
};

// Footprint with eaves stays within this radius of the origin.
constexpr double kHouseRadius = 6.7;

HouseType makeHouseType(int index, Random& random); // index 0..19

// Faces +z, its back at z = 0; the middle of its lower edge at the origin.
Mesh makeWindowFrame();
Mesh makeWindowPane();
Mesh makeShutter();
Mesh makeDoor(bool panelled);
Mesh makeChimney(bool wide);

constexpr double kWindowWidth = 1.0;
constexpr double kWindowHeight = 1.25;

struct Church {
    Mesh walls;
    Mesh roof;
    Mesh windows;
};

Church makeChurch(); // nave along z, tower at +z

// A gabled roof of overlapping courses along x, eaves at y = 0.
struct GableRoof {
    double length_x = 8.0;   // with overhang
    double half_depth = 3.0; // to the wall
    double rise = 3.0;       // ridge over eaves
    double overhang = 0.5;
    int courses = 7;
};

void addGableRoof(Mesh& mesh, const GableRoof& roof, const glm::dmat4& transform);

} // namespace lodestone::generate
