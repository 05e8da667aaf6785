#include "scene/generate/village_houses.h"

#include <algorithm>
#include <cmath>

namespace lodestone::generate {

namespace {

constexpr double kStorey = 2.7;
constexpr double kPlinth = 0.45;
constexpr double kFooting = 2.2; // below the doorstep, for slopes

constexpr std::array<std::uint32_t, 7> kWallColors{
    {0xE9DFC8, 0xDCC9A3, 0xD8B58C, 0xE4E0D6, 0xC9A78A, 0xE3CDA8, 0xCFC4B0}};
constexpr std::array<std::uint32_t, 5> kRoofColors{
    {0x9C4A32, 0x8A3F2E, 0xA85B3A, 0x6B4A3E, 0x5D5A5C}};

struct Size {
    double width; // along x
    double depth; // along z
    int storeys;
    double pitch; // rise of the roof over half the depth
    bool hipped;

    double eaves() const { return kPlinth + kStorey * storeys; }

    double rise() const { return depth / 2.0 * pitch; }
};

// A house body: walls up to the eaves and, unless hipped, gables at both ends of x.
void addBody(Mesh& mesh, const Size& size) {
    const double z = size.depth / 2.0;
    std::vector<Ring> rings;
    for (const double x : {-size.width / 2.0, size.width / 2.0}) {
        Ring ring{
            {x, -kFooting, z}, {x, size.eaves(), z}, {x, size.eaves(), -z}, {x, -kFooting, -z}};
        if (!size.hipped)
            ring.insert(ring.begin() + 2, glm::dvec3(x, size.eaves() + size.rise(), 0.0));
        std::ranges::reverse(ring);
        rings.push_back(std::move(ring));
    }
    addLoft(mesh, rings);
}

// Bands and corner stones that stand out of the wall a little.
void addTrim(Mesh& mesh, const Size& size) {
    const double x = size.width / 2.0;
    const double z = size.depth / 2.0;
    const auto band = [&](double low, double high, double out) {
        addBox(mesh, {-x - out, low, -z - out}, {x + out, high, z + out});
    };
    band(-kFooting, kPlinth, 0.10);
    for (int storey = 1; storey < size.storeys; ++storey)
        band(kPlinth + kStorey * storey - 0.1, kPlinth + kStorey * storey + 0.1, 0.06);
    band(size.eaves() - 0.22, size.eaves() - 0.02, 0.09);
    for (const double sx : {-1.0, 1.0})
        for (const double sz : {-1.0, 1.0}) {
            const glm::dvec3 corner(sx * (x - 0.12), 0.0, sz * (z - 0.12));
            addBox(mesh,
                   corner + glm::dvec3(-0.17, kPlinth, -0.17),
                   corner + glm::dvec3(0.17, size.eaves() - 0.2, 0.17));
        }
}

// Four slopes with stepped courses.
void addHippedRoof(Mesh& mesh, const Size& size) {
    constexpr int kCourses = 8;
    constexpr double kOverhang = 0.5;
    const double x = size.width / 2.0 + kOverhang;
    const double z = size.depth / 2.0 + kOverhang;
    const double drop = kOverhang * size.pitch;
    const double rise = size.rise() + drop;
    std::vector<Ring> rings;
    const auto ring = [&](double t, double lift) {
        const double in = t * (z - 0.12);
        const double y = size.eaves() - drop + rise * t + lift;
        rings.push_back({{-x + in, y, -z + in},
                         {-x + in, y, z - in},
                         {x - in, y, z - in},
                         {x - in, y, -z + in}});
    };
    ring(0.0, -0.12);
    for (int c = 0; c < kCourses; ++c) {
        ring(static_cast<double>(c) / kCourses, 0.10);
        ring((c + 0.97) / kCourses, 0.04);
    }
    ring(1.0, 0.12);
    addLoft(mesh, rings);
}

void addWindows(HouseType& type, const Size& size) {
    const int columns = std::max(2, static_cast<int>((size.width - 1.2) / 2.1));
    const double pitch = (size.width - 1.0) / columns;
    for (int storey = 0; storey < size.storeys; ++storey) {
        const double y = kPlinth + kStorey * storey + 0.85;
        for (int c = 0; c < columns; ++c) {
            const double x = -size.width / 2.0 + 0.5 + pitch * (c + 0.5);
            if (storey == 0 && c == columns / 2)
                type.doors.push_back({{x, kPlinth - 0.25, size.depth / 2.0}, 0.0});
            else
                type.windows.push_back({{x, y, size.depth / 2.0}, 0.0});
            if (c % 2 == 0 || storey == 0)
                type.windows.push_back({{-x, y, -size.depth / 2.0}, kPi});
        }
        for (const double side : {-1.0, 1.0})
            type.windows.push_back(
                {{side * size.width / 2.0, y, size.depth * 0.2}, side * kPi / 2.0});
    }
    if (!size.hipped && size.rise() > 2.6)
        for (const double side : {-1.0, 1.0})
            type.windows.push_back(
                {{side * size.width / 2.0, size.eaves() + 0.3, 0.0}, side * kPi / 2.0});
}

// A gabled bay in front of the middle or one end.
void addWing(HouseType& type, const Size& size, double x) {
    const Size wing{2.6 + 0.2 * size.storeys, 3.0, size.storeys, 1.05, false};
    const glm::dmat4 turn = moved({x, 0.0, size.depth / 2.0 - 0.3}) * rotatedY(kPi / 2.0);
    Mesh body;
    addBody(body, {wing.width, wing.depth, wing.storeys, wing.pitch, false});
    type.walls.append(body, turn);
    const double front = size.depth / 2.0 - 0.3 + wing.width / 2.0;
    std::erase_if(type.windows, [&](const Fitting& w) {
        return w.angle == 0.0 && std::abs(w.position.x - x) < wing.depth / 2.0 + kWindowWidth;
    });
    for (int storey = 0; storey < size.storeys; ++storey)
        type.windows.push_back({{x, kPlinth + kStorey * storey + 0.85, front}, 0.0});
    const GableRoof roof{wing.width + 0.7, wing.depth / 2.0, wing.rise(), 0.35, 5};
    addGableRoof(type.roof, roof, turn * moved({0.0, size.eaves(), 0.0}));
}

} // namespace

void addGableRoof(Mesh& mesh, const GableRoof& roof, const glm::dmat4& transform) {
    const double run = roof.half_depth + roof.overhang;
    const double slope = roof.rise / roof.half_depth;
    const double length = run * std::sqrt(1.0 + slope * slope);
    const glm::dvec2 up = glm::normalize(glm::dvec2(1.0, slope)); // (inwards, upwards)
    const double course = length / roof.courses;
    for (const double side : {-1.0, 1.0})
        for (int c = 0; c < roof.courses; ++c) {
            // Courses overlap; each lies a little steeper than the slope, on the one below.
            const double from = course * c;
            const double to = std::min(course * (c + 1) + 0.10, length + 0.02);
            const auto at = [&](double along, double out) {
                const glm::dvec2 p = up * along + glm::dvec2(-up.y, up.x) * out;
                return glm::dvec2(run - p.x, p.y - roof.overhang * slope);
            };
            const std::array<glm::dvec2, 4> section{
                at(from, -0.02), at(from, 0.17), at(to, 0.09), at(to, -0.02)};
            std::vector<Ring> rings;
            for (const double x : {-roof.length_x / 2.0, roof.length_x / 2.0}) {
                Ring ring;
                for (const glm::dvec2& p : section)
                    ring.emplace_back(transform * glm::dvec4(x, p.y, side * p.x, 1.0));
                if (side > 0.0)
                    std::ranges::reverse(ring);
                rings.push_back(std::move(ring));
            }
            addLoft(mesh, rings);
        }
    Mesh ridge;
    const double half = roof.length_x / 2.0 + 0.05;
    addBox(ridge, {-half, roof.rise - 0.05, -0.16}, {half, roof.rise + 0.22, 0.16});
    mesh.append(ridge, transform);
}

HouseType makeHouseType(int index, Random& random) {
    const auto i = static_cast<std::size_t>(index);
    const bool hipped = index % 5 == 3;
    Size size{random.in(7.0, 9.6),
              random.in(5.6, 6.8),
              index % 3 == 0 ? 1 : 2,
              random.in(0.85, 1.25),
              hipped};
    if (hipped)
        size.pitch = 0.8;
    HouseType type;
    type.wall_color = kWallColors[i % kWallColors.size()];
    type.roof_color = kRoofColors[i % kRoofColors.size()];
    type.shutters = index % 2 == 0;
    addBody(type.walls, size);
    addTrim(type.walls, size);
    addWindows(type, size);
    if (hipped)
        addHippedRoof(type.roof, size);
    else
        addGableRoof(type.roof,
                     {size.width + 0.8, size.depth / 2.0, size.rise(), 0.45, 7 + index % 3},
                     moved({0.0, size.eaves(), 0.0}));
    if (index % 4 == 1)
        addWing(type, size, size.width * (index % 8 == 1 ? 0.28 : -0.28));
    const double along = size.width * (hipped ? 0.12 : 0.3);
    type.chimneys.push_back({{along, size.eaves() + size.rise() * 0.62, -size.depth * 0.12}, 0.0});
    if (size.width > 8.4 && !hipped)
        type.chimneys.push_back(
            {{-along, size.eaves() + size.rise() * 0.62, -size.depth * 0.12}, 0.0});
    return type;
}

Mesh makeWindowFrame() {
    Mesh mesh;
    const double x = kWindowWidth / 2.0;
    const double h = kWindowHeight;
    const auto box = [&](double x0, double y0, double x1, double y1, double out) {
        addBox(mesh, {x0, y0, -0.03}, {x1, y1, out});
    };
    box(-x, 0.0, -x + 0.09, h, 0.07);
    box(x - 0.09, 0.0, x, h, 0.07);
    box(-x + 0.09, h - 0.09, x - 0.09, h, 0.07);
    box(-x + 0.09, 0.0, x - 0.09, 0.08, 0.07);
    box(-0.03, 0.08, 0.03, h - 0.09, 0.055);
    box(-x + 0.09, h * 0.6, -0.03, h * 0.6 + 0.05, 0.05);
    box(0.03, h * 0.6, x - 0.09, h * 0.6 + 0.05, 0.05);
    box(-x - 0.1, -0.09, x + 0.1, 0.0, 0.17);
    return mesh;
}

Mesh makeWindowPane() {
    Mesh mesh;
    const double x = kWindowWidth / 2.0 - 0.06;
    addBox(mesh, {-x, 0.05, -0.02}, {x, kWindowHeight - 0.05, 0.03});
    return mesh;
}

Mesh makeShutter() {
    Mesh mesh;
    const double h = kWindowHeight;
    addBox(mesh, {-0.25, 0.0, 0.01}, {0.25, h, 0.05});
    for (const double y : {0.12, h * 0.5 - 0.05, h - 0.22})
        addBox(mesh, {-0.23, y, 0.05}, {0.23, y + 0.1, 0.075});
    return mesh;
}

Mesh makeDoor(bool panelled) {
    Mesh mesh;
    addBox(mesh, {-0.5, 0.25, -0.02}, {0.5, 2.3, 0.06});
    for (const double side : {-1.0, 1.0}) {
        const double x = side * 0.57;
        addBox(mesh, {x - 0.08, 0.25, -0.02}, {x + 0.08, 2.4, 0.13});
        for (int row = 0; row < (panelled ? 3 : 1); ++row) {
            const double y = 0.4 + row * 0.62;
            const double h = panelled ? 0.5 : 1.7;
            addBox(mesh, {side * 0.25 - 0.17, y, 0.06}, {side * 0.25 + 0.17, y + h, 0.085});
        }
    }
    addBox(mesh, {-0.75, 2.4, -0.02}, {0.75, 2.55, 0.22});
    addBox(mesh, {-0.75, -1.2, -0.02}, {0.75, 0.25, 0.55}); // the steps
    addBox(mesh, {-0.75, -1.2, 0.55}, {0.75, 0.05, 0.85});
    return mesh;
}

Mesh makeChimney(bool wide) {
    Mesh mesh;
    const double x = wide ? 0.5 : 0.33;
    addBox(mesh, {-x, -1.2, -0.33}, {x, 2.1, 0.33});
    addBox(mesh, {-x - 0.09, 2.1, -0.42}, {x + 0.09, 2.28, 0.42});
    for (const double side : wide ? std::vector<double>{-0.25, 0.25} : std::vector<double>{0.0}) {
        Mesh pot;
        addTurned(pot, std::array<glm::dvec2, 2>{{{0.16, 2.28}, {0.12, 2.75}}}, 8);
        mesh.append(pot, moved({side, 0.0, 0.0}));
    }
    return mesh;
}

} // namespace lodestone::generate
