#include "app/cli.h"
#include "scene/generate.h"
#include "simplify/algorithm.h"
#include "tests/scene/scene_fixtures.h"

#include <algorithm>
#include <fmt/core.h>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unistd.h>

namespace lodestone {

namespace {

using Json = nlohmann::json;

struct Ran {
    int code = 0;
    std::string out;
    std::string err;
    std::optional<WindowRequest> window;
};

// Writes a small file and remembers what it was asked for.
class FakeImages final : public ImageSource {
public:
    Result<RenderReport> render(const RenderRequest& request, const JobContext&) override {
        last = request;
        std::ofstream(request.path) << "picture";
        RenderReport report{request.width_px, request.height_px, {}, "fake"};
        if (request.measure)
            report.frame_ms.assign(request.columns.size(), 2.5);
        return report;
    }

    // Small grey pictures, as bright as the share of the original's triangles that the column
    // keeps.
    Result<void>
    draw(const PictureRequest& request, const PictureSink& sink, const JobContext&) override {
        const double all = static_cast<double>(request.columns[0].lod->triangles);
        for (std::size_t column = 0; column < request.columns.size(); ++column)
            for (std::size_t view = 0; view < request.views.size(); ++view) {
                const double share =
                    static_cast<double>(request.columns[column].lod->triangles) / all;
                Picture picture{16, 12, {}};
                picture.rgba.assign(std::size_t{4} * 16 * 12,
                                    static_cast<std::uint8_t>(std::min(share, 1.0) * 255.0));
                if (Result<void> taken = sink({column, view}, std::move(picture)); !taken)
                    return taken;
            }
        return {};
    }

    RenderRequest last;
};

class CliTest : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        folder = std::filesystem::temp_directory_path() /
                 ("lodestone_cli_test_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder);
    }

    static void TearDownTestSuite() { std::filesystem::remove_all(folder); }

    Ran run(std::vector<std::string> arguments) {
        std::vector<const char*> argv{"lodestone"};
        for (const std::string& argument : arguments)
            argv.push_back(argument.c_str());
        std::ostringstream out;
        std::ostringstream err;
        const CliEnvironment environment{out, err, images, stop.get_token(), false, "parts"};
        const CliOutcome outcome =
            runCommandLine(static_cast<int>(argv.size()), argv.data(), environment);
        return {outcome.exit_code, out.str(), err.str(), outcome.window};
    }

    static std::string path(const std::string& name) { return (folder / name).string(); }

    // The chair: 6 submeshes, 68 instances, 2,240 triangles.
    std::string chair() {
        const std::string file = path("chair.glb");
        if (!std::filesystem::exists(file)) {
            EXPECT_EQ(run({"generate", "chair", "-o", file}).code, 0);
        }
        return file;
    }

    static std::string contents(const std::string& file) {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    inline static std::filesystem::path folder;
    FakeImages fake_images;
    ImageSource* images = &fake_images;
    std::stop_source stop;
};

void expectOneLine(const Ran& ran) {
    EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
    EXPECT_TRUE(ran.err.starts_with("lodestone: ")) << ran.err;
    EXPECT_TRUE(ran.out.empty()) << ran.out;
}

std::vector<std::string> keysOf(const Json& json) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : json.items())
        keys.push_back(key);
    return keys;
}

const std::vector<std::string> kRowKeys = {"algorithm",
                                           "bytes",
                                           "error",
                                           "instances",
                                           "notes",
                                           "predicted_bytes",
                                           "seconds",
                                           "triangles",
                                           "unique_triangles"};

// What compare tells of a row besides.
std::vector<std::string> comparedKeys() {
    std::vector<std::string> keys = kRowKeys;
    keys.insert(keys.end(), {"bytes_by_part", "image", "target_met"});
    std::ranges::sort(keys);
    return keys;
}

} // namespace

TEST_F(CliTest, WrongUsageIsOneLineAndExitCode2) {
    const std::string in = chair();
    const std::string out = path("never.glb");
    const std::vector<std::vector<std::string>> wrong = {
        {"frobnicate"},
        {"frobnicate", "a", "b"},
        {"--json"},
        {"info"},
        {"info", in, "surplus"},
        {"info", in, "--threads", "0"},
        {"info", in, "--threads", "two"},
        {"simplify", in, "-o", out, "--algorithm", "ias"},
        {"simplify", in, "-o", out, "--ratio", "0.5"},
        {"simplify", in, "--algorithm", "ias", "--ratio", "0.5"},
        {"simplify", in, "-o", out, "--algorithm", "nope", "--ratio", "0.5"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "1.5"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "-0.1"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "nan"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "inf"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "0.5x"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "20%"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", ""},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--triangles", "1.5"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--bytes", "0"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--error", "-1"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "0.5", "--bytes", "900"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "0.5", "--param", "x"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "0.5", "--param", "x=1"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "0.5", "--ordering", "x"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "0.5", "--scope", "x"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "0.5", "--instancing", "x"},
        {"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "0.5", "--compress", "zip"},
        {"simplify", in, "-o", path("out.obj"), "--algorithm", "ias", "--ratio", "0.5"},
        {"simplify", in, "-o", in, "--algorithm", "ias", "--ratio", "0.5"},
        {"compare", in},
        {"compare", in, "--algorithms", "ias,nope", "--ratio", "0.5"},
        {"compare", in, "--algorithms", "", "--ratio", "0.5"},
        {"compare", in, "--ratio", "0.5", "--triangles", "9"},
        {"distance", in},
        {"distance", in, in, "--samples", "0"},
        {"render", in, "-o", path("a.jpg")},
        {"render", in, "-o", path("a.png"), "--size", "0x100"},
        {"render", in, "-o", path("a.png"), "--size", "100"},
        {"render", in, "-o", path("a.png"), "--camera", "1,2"},
        {"render", in, "-o", path("a.png"), "--camera", "1,2,nan"},
        {"render", in, "-o", path("a.png"), "--shading", "pink"},
        {"render", in, "-o", path("a.png"), "--file-camera", "3"},
        {"render", in, "-o", path("a.png"), "--ratio", "0.5"},
        {"generate", "spoon", "-o", path("spoon.glb")},
        {"generate", "chair", "-o", path("chair.stl")},
        {"generate", "chair", "-o", path("c.glb"), "--seed", "-1"},
    };
    for (const std::vector<std::string>& arguments : wrong) {
        const Ran ran = run(arguments);
        std::string text;
        for (const std::string& argument : arguments)
            text += argument + " ";
        SCOPED_TRACE(text);
        EXPECT_EQ(ran.code, 2) << ran.err;
        expectOneLine(ran);
    }
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(CliTest, UnreadableInputIsOneLineThatNamesTheFileAndExitCode3) {
    const std::string broken = path("broken.glb");
    std::ofstream(broken) << "not a glTF file";
    for (const std::string& file : {path("missing.glb"), broken}) {
        for (const std::vector<std::string>& arguments :
             {std::vector<std::string>{"info", file, "--json"},
              {"simplify", file, "-o", path("x.glb"), "--algorithm", "ias", "--ratio", "0.5"},
              {"distance", chair(), file},
              {"compare", file, "--ratio", "0.5"},
              {"render", file, "-o", path("x.png")}}) {
            const Ran ran = run(arguments);
            EXPECT_EQ(ran.code, 3) << ran.err;
            expectOneLine(ran);
            EXPECT_NE(ran.err.find(std::filesystem::path(file).filename().string()),
                      std::string::npos);
        }
    }
}

TEST_F(CliTest, InfoTellsTheCountsOfTheFile) {
    const Ran ran = run({"info", chair(), "--json"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const Json json = Json::parse(ran.out);
    const std::vector<std::string> keys = {"animations",
                                           "bytes",
                                           "diagonal",
                                           "images",
                                           "instances",
                                           "materials",
                                           "notes",
                                           "submeshes",
                                           "triangles",
                                           "unique_triangles",
                                           "vertices"};
    EXPECT_EQ(keysOf(json), keys);
    EXPECT_EQ(json["submeshes"], 6);
    EXPECT_EQ(json["instances"], 68);
    EXPECT_EQ(json["triangles"], 2240);
    EXPECT_EQ(json["bytes"], std::filesystem::file_size(chair()));
    EXPECT_NE(run({"info", chair()}).out.find("2,240"), std::string::npos);
}

TEST_F(CliTest, SimplifyReportsWhatTheWrittenFileHolds) {
    for (const std::string id : {"ias", "quadric", "quadric-submesh"}) {
        const std::string file = path("chair_" + id + ".glb");
        const Ran ran = run({"simplify",
                             chair(),
                             "-o",
                             file,
                             "--algorithm",
                             id,
                             "--ratio",
                             "0.5",
                             "--measure",
                             "--json"});
        ASSERT_EQ(ran.code, 0) << ran.err;
        const Json row = Json::parse(ran.out);
        EXPECT_EQ(keysOf(row), kRowKeys);
        EXPECT_EQ(row["algorithm"], id);
        EXPECT_LE(row["triangles"], 1120);
        EXPECT_GT(row["triangles"], 0);
        EXPECT_EQ(row["bytes"], std::filesystem::file_size(file));
        EXPECT_EQ(row["bytes"], row["predicted_bytes"]);
        const Json distance = Json::parse(run({"distance", chair(), file, "--json"}).out);
        EXPECT_GT(row["error"]["hausdorff"], 0.0);
        for (const char* key : {"hausdorff", "mean", "rms"})
            EXPECT_EQ(row["error"][key], distance[key]) << key;
        const Json info = Json::parse(run({"info", file, "--json"}).out);
        EXPECT_EQ(info["triangles"], row["triangles"]);
        EXPECT_EQ(info["unique_triangles"], row["unique_triangles"]);
        EXPECT_EQ(info["instances"], row["instances"]);
    }
}

TEST_F(CliTest, TheSameCommandWritesTheSameBytesOnAnyNumberOfThreads) {
    for (const std::string id : {"ias", "quadric"}) {
        for (const std::string threads : {"1", "4"})
            ASSERT_EQ(run({"simplify",
                           chair(),
                           "-o",
                           path(threads + ".glb"),
                           "--algorithm",
                           id,
                           "--ratio",
                           "0.3",
                           "--threads",
                           threads})
                          .code,
                      0);
        EXPECT_TRUE(contents(path("1.glb")) == contents(path("4.glb"))) << id;
    }
}

TEST_F(CliTest, StepsAreOrderedByBytesForAByteTargetElseByTriangles) {
    const auto written = [&](const std::string& kind, const std::string& value, auto... ordering) {
        std::vector<std::string> arguments{
            "simplify", chair(), "-o", path("ordered.glb"), "--algorithm", "ias", kind, value};
        (arguments.push_back(ordering), ...);
        EXPECT_EQ(run(arguments).code, 0);
        return contents(path("ordered.glb"));
    };
    const auto by_bytes = written("--bytes", "16000", "--ordering", "byte");
    EXPECT_TRUE(written("--bytes", "16000") == by_bytes);
    EXPECT_FALSE(written("--bytes", "16000", "--ordering", "triangle") == by_bytes);
    const auto by_triangles = written("--ratio", "0.3", "--ordering", "triangle");
    EXPECT_TRUE(written("--ratio", "0.3") == by_triangles);
    EXPECT_FALSE(written("--ratio", "0.3", "--ordering", "byte") == by_triangles);
}

TEST_F(CliTest, AMissedTargetIsDoneAndSaysWhy) {
    const Ran ran = run({"simplify",
                         chair(),
                         "-o",
                         path("floor.glb"),
                         "--algorithm",
                         "quadric-submesh",
                         "--bytes",
                         "1",
                         "--json"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_FALSE(Json::parse(ran.out)["notes"].empty());
}

TEST_F(CliTest, AnInterruptedCommandIsExitCode130AndLeavesNoFile) {
    const std::string in = chair();
    stop.request_stop();
    const std::string out = path("interrupted.glb");
    const Ran ran = run({"simplify", in, "-o", out, "--algorithm", "ias", "--ratio", "0.5"});
    EXPECT_EQ(ran.code, 130);
    expectOneLine(ran);
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(CliTest, AMissingFolderIsToldBeforeTheWorkAndIsExitCode1) {
    const Ran ran = run({"simplify",
                         path("unread.glb"),
                         "-o",
                         path("no/such/folder.glb"),
                         "--algorithm",
                         "ias",
                         "--ratio",
                         "0.5"});
    EXPECT_EQ(ran.code, 1);
    expectOneLine(ran);
    for (const std::string option : {"--csv", "--html"}) {
        const Ran compared =
            run({"compare", path("unread.glb"), "--ratio", "0.5", option, path("no/such/file")});
        EXPECT_EQ(compared.code, 1);
        expectOneLine(compared);
    }
}

TEST_F(CliTest, CompareHasARowForEveryAlgorithmOfTheTable) {
    const std::string csv = path("rows.csv");
    const Ran ran = run({"compare", chair(), "--ratio", "0.5", "--json", "--csv", csv});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const Json json = Json::parse(ran.out);
    ASSERT_EQ(json["rows"].size(), algorithms().size());
    for (std::size_t index = 0; index < algorithms().size(); ++index) {
        EXPECT_EQ(json["rows"][index]["algorithm"], std::string(algorithms()[index].id));
        EXPECT_EQ(keysOf(json["rows"][index]), comparedKeys());
    }
    EXPECT_EQ(json["original"]["triangles"], 2240);
    const std::string text = contents(csv);
    EXPECT_EQ(std::ranges::count(text, '\n'), static_cast<std::ptrdiff_t>(algorithms().size()) + 2);
}

TEST_F(CliTest, CompareWritesEveryRowToKnowItsBytes) {
    const Ran ran =
        run({"compare", chair(), "--algorithms", "ias,quadric", "--ratio", "0.4", "--json"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const Json json = Json::parse(ran.out);
    const std::string file = path("chair_by_hand.glb");
    for (const Json& row : json["rows"]) {
        const std::string id = row["algorithm"];
        ASSERT_EQ(run({"simplify", chair(), "-o", file, "--algorithm", id, "--ratio", "0.4"}).code,
                  0);
        EXPECT_EQ(row["bytes"], std::filesystem::file_size(file)) << id;
        EXPECT_EQ(row["bytes"], row["predicted_bytes"]) << id;
        std::uint64_t sum = 0;
        for (const auto& [part, bytes] : row["bytes_by_part"].items())
            sum += bytes.get<std::uint64_t>();
        EXPECT_EQ(row["bytes"], sum) << id;
    }
}

TEST_F(CliTest, ComparePutsTheImageDifferenceOfTheSourceIntoEveryRow) {
    // The fake pictures are the darker the fewer triangles are kept.
    const auto flip = [&](const std::string& ratio) {
        const Ran ran =
            run({"compare", chair(), "--algorithms", "ias", "--ratio", ratio, "--json"});
        EXPECT_EQ(ran.code, 0) << ran.err;
        return Json::parse(ran.out)["rows"][0]["image"]["flip"].get<double>();
    };
    const double near = flip("0.9");
    EXPECT_GT(near, 0.0);
    EXPECT_LT(near, flip("0.5"));
}

TEST_F(CliTest, CompareSaysHowFarARowIsFromTheTarget) {
    const Ran ran = run({"compare", chair(), "--algorithms", "quadric-submesh", "--bytes", "1000"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("note: quadric-submesh: the target is missed: "), std::string::npos);
    EXPECT_NE(ran.out.find(" % above"), std::string::npos) << ran.out;
}

TEST_F(CliTest, CompareWithoutPixelsIsCompleteButForThePictures) {
    images = nullptr;
    const std::string page = path("plain.html");
    const Ran ran =
        run({"compare", chair(), "--algorithms", "ias", "--ratio", "0.5", "--html", page});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("no image difference"), std::string::npos) << ran.out;
    const std::string text = contents(page);
    EXPECT_NE(text.find("There are no pictures"), std::string::npos);
    EXPECT_EQ(text.find("<img"), std::string::npos);
    EXPECT_NE(text.find("<tr data-algorithm=\"ias\">"), std::string::npos);
}

TEST_F(CliTest, ComparePagesShowTheOriginalAndEveryRow) {
    const std::string page = path("page.html");
    const Ran ran =
        run({"compare", chair(), "--algorithms", "ias,quadric", "--ratio", "0.5", "--html", page});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const std::string text = contents(page);
    for (const std::string_view row : {"original", "ias", "quadric"})
        EXPECT_NE(text.find(fmt::format("<tr data-algorithm=\"{}\">", row)), std::string::npos);
    for (int index = 0; index < 3; ++index)
        EXPECT_NE(text.find(fmt::format("<img id=\"picture-{}\"", index)), std::string::npos);
}

TEST_F(CliTest, AFileIsAtNoDistanceFromItselfAndAtSomeFromItsLod) {
    const std::string lod = path("lod.glb");
    ASSERT_EQ(run({"simplify", chair(), "-o", lod, "--algorithm", "ias", "--ratio", "0.3"}).code,
              0);
    const Json same =
        Json::parse(run({"distance", chair(), chair(), "--samples", "2000", "--json"}).out);
    EXPECT_LT(same["hausdorff"], 1e-4);
    const Json other =
        Json::parse(run({"distance", chair(), lod, "--samples", "2000", "--json"}).out);
    EXPECT_GT(other["hausdorff"], 1e-3);
    EXPECT_GE(other["hausdorff"], other["mean"]);
}

TEST_F(CliTest, RenderPassesTheViewAndTheColumnsOn) {
    const Ran ran = run({"render",
                         chair(),
                         "-o",
                         path("p.png"),
                         "--size",
                         "320x200",
                         "--camera",
                         "30,-10,2.5",
                         "--shading",
                         "clay",
                         "--wireframe",
                         "--compare",
                         "original,ias",
                         "--ratio",
                         "0.5",
                         "--measure",
                         "--json"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const RenderRequest& request = fake_images.last;
    ASSERT_EQ(request.columns.size(), 2u);
    EXPECT_EQ(request.columns[0].lod->triangles, 2240u);
    EXPECT_LE(request.columns[1].lod->triangles, 1120u);
    EXPECT_EQ(request.width_px, 320u);
    EXPECT_EQ(request.height_px, 200u);
    EXPECT_EQ(request.shading, ShadingMode::Clay);
    EXPECT_TRUE(request.wireframe);
    EXPECT_DOUBLE_EQ(request.orbit->elevation_deg, -10.0);
    const Json json = Json::parse(ran.out);
    EXPECT_EQ(json["columns"][1]["frame_ms"], 2.5);
}

TEST_F(CliTest, WithoutPixelsRenderFailsWithExitCode1) {
    images = nullptr;
    const Ran ran = run({"render", chair(), "-o", path("none.png")});
    EXPECT_EQ(ran.code, 1);
    expectOneLine(ran);
}

TEST_F(CliTest, EveryCommandExplainsItself) {
    for (const std::string command :
         {"info", "simplify", "compare", "distance", "render", "generate"}) {
        const Ran ran = run({command, "--help"});
        EXPECT_EQ(ran.code, 0);
        EXPECT_NE(ran.out.find("--threads"), std::string::npos) << command;
        EXPECT_TRUE(ran.err.empty());
    }
    const std::string help = run({"simplify", "--help"}).out;
    for (const Algorithm& algorithm : algorithms()) {
        EXPECT_NE(help.find(algorithm.id), std::string::npos);
        for (const ParameterInfo& parameter : algorithm.parameters)
            EXPECT_NE(help.find(parameter.id), std::string::npos) << parameter.id;
    }
}

TEST_F(CliTest, TheTableOfAlgorithmsIsListed) {
    const Json json = Json::parse(run({"--list-algorithms", "--json"}).out);
    ASSERT_EQ(json["algorithms"].size(), algorithms().size());
    for (std::size_t index = 0; index < algorithms().size(); ++index)
        EXPECT_EQ(json["algorithms"][index]["parameters"].size(),
                  algorithms()[index].parameters.size());
    const std::string text = run({"--list-algorithms"}).out;
    EXPECT_EQ(std::ranges::count(text, '\n'), static_cast<std::ptrdiff_t>(algorithms().size()));
}

TEST_F(CliTest, VersionNamesTheOptionalParts) {
    const Ran ran = run({"--version"});
    EXPECT_EQ(ran.code, 0);
    EXPECT_NE(ran.out.find("(parts)"), std::string::npos);
}

TEST_F(CliTest, NoCommandAsksForTheWindow) {
    const Ran none = run({});
    ASSERT_TRUE(none.window.has_value());
    EXPECT_FALSE(none.window->file.has_value());
    const Ran file = run({"some scene.glb"});
    ASSERT_TRUE(file.window.has_value());
    EXPECT_EQ(file.window->file, "some scene.glb");
}

TEST_F(CliTest, WithoutADisplayTheComparisonIsWrittenAsTableAndPicture) {
    std::ostringstream out;
    std::ostringstream err;
    const CliEnvironment environment{out, err, images, {}, false, ""};
    const std::filesystem::path before = std::filesystem::current_path();
    const WindowRequest request{chair()};
    std::filesystem::current_path(folder);
    const int code = compareWithoutDisplay(request, environment);
    std::filesystem::current_path(before);
    ASSERT_EQ(code, 0) << err.str();
    EXPECT_TRUE(std::filesystem::exists(path("lodestone-comparison.png")));
    EXPECT_TRUE(std::filesystem::exists(path("lodestone-comparison.html")));
    EXPECT_EQ(fake_images.last.columns.size(), 3u);
    for (const std::string_view word : {"original", "ias", "quadric", "2,240"})
        EXPECT_NE(out.str().find(word), std::string::npos) << word;
}

} // namespace lodestone
