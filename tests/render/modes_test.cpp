// What a sample looks like in every mode, as mean colours of twelve fields of the picture: a change
// of the look shows here and is to be looked at. Fields, because renderers differ in edges.
#include "scene/generate.h"
#include "tests/render/view_fixture.h"

#include <cstdio>
#include <gtest/gtest.h>
#include <sstream>

namespace lodestone {
namespace {

using namespace tests;

constexpr int kColumns = 4;
constexpr int kRows = 3;
constexpr int kTolerance = 5; // of 255

using Fields = std::array<std::uint32_t, std::size_t{kColumns} * kRows>; // 0xRRGGBB, rows top-down

struct Look {
    const char* name;
    Shading shading;
    void (*more)(ViewOptions&); // null: nothing
    const char* fields;         // as Fields, in hexadecimal digits
};

void showWires(ViewOptions& options) {
    options.wireframe = true;
}

void showFloor(ViewOptions& options) {
    options.grid = true;
}

void showLightBackground(ViewOptions& options) {
    options.background = Background::Solid;
    options.background_srgb = {0.87f, 0.88f, 0.90f};
}

const std::array<Look, 12> kLooks = {{
    {"lit",
     Shading::Lit,
     nullptr,
     "1e2329 2f2d2e 775a43 1e2329 "
     "1a1e23 6c523e 775941 1a1e23 "
     "16191d 1b1c1f 252221 16191e"},
    {"clay",
     Shading::Clay,
     nullptr,
     "1e2329 2e3237 717070 1e2329 "
     "1a1e23 676768 717070 1a1e23 "
     "16191d 1a1e22 25282b 16191e"},
    {"matcap",
     Shading::Matcap,
     nullptr,
     "1e2329 2d3136 6c6b6c 1e2329 "
     "1a1e23 656668 707072 1a1e23 "
     "16191d 1a1d21 24262a 16191e"},
    {"flat",
     Shading::Flat,
     nullptr,
     "1e2329 2b2a2a 624933 1e2329 "
     "1a1e23 58422e 60452f 1a1e23 "
     "16191d 191b1e 211f1f 16191e"},
    {"normals",
     Shading::Normals,
     nullptr,
     "1e2329 30343d 6b6ca1 1e2329 "
     "1a1e23 62767a 798089 1a1e23 "
     "16191d 1e1e25 2c2836 16191e"},
    {"uv checker",
     Shading::UvChecker,
     nullptr,
     "1e2329 282b31 504d52 1e2329 "
     "1a1e23 4a484c 4f4c50 1a1e23 "
     "16191d 181c20 1f2125 16191e"},
    {"by submesh",
     Shading::BySubmesh,
     nullptr,
     "1e2329 2b2e2c 397e41 1e2329 "
     "1a1e23 4b415c 50554e 1a1e23 "
     "16191d 1a1c1e 242420 16191e"},
    {"by instance",
     Shading::ByInstance,
     nullptr,
     "1e2329 302c2f 4e6965 1e2329 "
     "1a1e23 60575a 536d5c 1a1e23 "
     "16191d 1b1c20 252423 16191e"},
    {"by LOD state",
     Shading::ByLodState,
     nullptr,
     "1e2329 2a2e33 5c5d5f 1e2329 "
     "1a1e23 545658 5b5c5e 1a1e23 "
     "16191d 191c21 212428 16191e"},
    {"wireframe",
     Shading::Clay,
     showWires,
     "1e2329 2d3337 6b7371 1e2329 "
     "1a1e23 626a68 6b7371 1a1e23 "
     "16191d 1a1e22 24292c 16191e"},
    {"floor",
     Shading::Lit,
     showFloor,
     "21262b 323030 785b43 21252b "
     "24282d 715742 7b5c44 24272c "
     "1c1f23 212325 2b2827 1e2125"},
    {"light background",
     Shading::Lit,
     showLightBackground,
     "dee0e6 d5d1d2 bd9f87 dddfe5 "
     "dddfe5 bfa48f b5967e dee0e6 "
     "dee0e6 d9d9dd d1cdce dee0e6"},
}};

Fields fieldsOf(const Pixels& pixels) {
    Fields fields{};
    const std::uint32_t width = pixels.width / kColumns;
    const std::uint32_t height = pixels.height / kRows;
    for (std::uint32_t field = 0; field < fields.size(); ++field) {
        std::array<std::uint64_t, 3> sum{};
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) {
                const Rgba8 pixel =
                    pixels.at(field % kColumns * width + x, field / kColumns * height + y);
                for (std::size_t c = 0; c < 3; ++c)
                    sum[c] += pixel[c];
            }
        for (const std::uint64_t channel : sum)
            fields[field] =
                fields[field] << 8 | static_cast<std::uint32_t>(channel / (width * height));
    }
    return fields;
}

Fields fieldsOf(const char* text) {
    Fields fields{};
    std::istringstream words(text);
    for (std::uint32_t& field : fields)
        words >> std::hex >> field;
    EXPECT_TRUE(words) << text;
    return fields;
}

int channelOf(std::uint32_t color, int channel) {
    return static_cast<int>(color >> (8 * channel) & 0xff);
}

class ModesTest : public ViewTest {};

TEST_F(ModesTest, EveryModeOfTheChairLooksAsItDid) {
    const auto chair = generateScene("chair", 1);
    ASSERT_TRUE(chair);
    load(*chair, fullLod(**chair));
    input_.size = {160, 120};
    frameCamera(input_.camera, robustWorldBounds(**chair), input_.size.aspect());
    for (const Look& look : kLooks) {
        input_.options = {};
        input_.options.shading = look.shading;
        for (std::size_t i = 0; i < input_.options.value_colors.size(); ++i)
            input_.options.value_colors[i] = glm::vec3(static_cast<float>(i) / 8.0f);
        if (look.more != nullptr)
            look.more(input_.options);
        const Fields found = fieldsOf(draw());
        const Fields wanted = fieldsOf(look.fields);
        int worst = 0;
        std::string text;
        for (std::size_t field = 0; field < found.size(); ++field) {
            for (int c = 0; c < 3; ++c)
                worst = std::max(
                    worst, std::abs(channelOf(found[field], c) - channelOf(wanted[field], c)));
            char hex[16] = "";
            std::snprintf(hex, sizeof hex, "%06x ", found[field]);
            text += hex;
        }
        EXPECT_LE(worst, kTolerance) << look.name << ": " << text;
    }
}

} // namespace
} // namespace lodestone
