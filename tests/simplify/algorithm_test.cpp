#include "scene/generate.h"
#include "simplify/algorithm.h"
#include "tests/scene/scene_fixtures.h"
#include "tests/simplify/meshes.h"

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <set>
#include <tbb/global_control.h>
#include <thread>
#include <unistd.h>

namespace lodestone {

namespace {

using meshes::submeshOf;

constexpr std::array kRatios{0.7, 0.3, 0.1};

// The class and what it is good for; all of them can be exported.
std::vector<ScenePtr> assetClasses() {
    return {meshes::sceneOf({submeshOf({meshes::sphere(12, 16)})}, {{glm::dmat4(1.0)}}),
            meshes::sceneOf({submeshOf({meshes::grid(10), meshes::soup(40)}),
                             submeshOf({meshes::torus(10, 8)})},
                            {meshes::gridOfTransforms(3, 4.0), meshes::gridOfTransforms(2, 9.0)}),
            fixtures::twoMaterialCubeScene(),
            fixtures::awkwardInstancesScene(),
            fixtures::gridScene(12),
            generateScene("chair").value()};
}

LodSourcePtr prepared(const Algorithm& algorithm, const ScenePtr& scene) {
    Result<LodSourcePtr> source = algorithm.prepare(scene, {}, {}, {});
    EXPECT_TRUE(source.has_value());
    return source.value();
}

class ExportFolder {
public:
    ExportFolder()
        : path_(std::filesystem::temp_directory_path() /
                ("lodestone_algorithm_test_" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(path_);
    }

    ~ExportFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    ExportFolder(const ExportFolder&) = delete;
    ExportFolder& operator=(const ExportFolder&) = delete;

    std::string exported(const Scene& scene, const Lod& lod) const {
        const std::filesystem::path file = path_ / "lod.glb";
        const Result<ExportReport> report = exportScene(scene, lod, file, {});
        EXPECT_TRUE(report.has_value()) << report.error().message;
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

private:
    std::filesystem::path path_;
};

} // namespace

TEST(Algorithms, HaveUniqueIdsAndNames) {
    std::set<std::string_view> ids;
    std::set<std::string_view> names;
    for (const Algorithm& algorithm : algorithms()) {
        EXPECT_TRUE(ids.insert(algorithm.id).second) << algorithm.id;
        EXPECT_TRUE(names.insert(algorithm.short_name).second) << algorithm.short_name;
        EXPECT_FALSE(algorithm.name.empty());
        EXPECT_FALSE(algorithm.paper.empty());
        EXPECT_FALSE(algorithm.summary.empty());
        EXPECT_NE(algorithm.prepare, nullptr);
        EXPECT_EQ(findAlgorithm(algorithm.id), &algorithm);
    }
    EXPECT_EQ(findAlgorithm("nothing"), nullptr);
    for (const std::string_view id : {"ias", "quadric", "quadric-submesh"})
        EXPECT_NE(findAlgorithm(id), nullptr) << id;
}

TEST(Algorithms, ParametersAreUniqueAndTheirDefaultsValid) {
    for (const Algorithm& algorithm : algorithms()) {
        std::set<std::string_view> ids;
        for (const ParameterInfo& info : algorithm.parameters) {
            EXPECT_TRUE(ids.insert(info.id).second) << info.id;
            EXPECT_FALSE(info.label.empty()) << info.id;
            EXPECT_FALSE(info.tooltip.empty()) << info.id;
            EXPECT_EQ(parameterValue(algorithm, {}, info.id), info.fallback);
            EXPECT_EQ(parameterValue(algorithm, {{std::string(info.id), 7.0}}, info.id), 7.0);
            if (info.kind == ParameterInfo::Kind::Choice) {
                EXPECT_LT(info.fallback, static_cast<double>(info.choices.size()));
            } else {
                EXPECT_GE(info.fallback, info.minimum);
                EXPECT_LE(info.fallback, info.maximum);
            }
        }
    }
}

TEST(Algorithms, ParametersParseByTheirKind) {
    const Algorithm& ias = *findAlgorithm("ias");
    EXPECT_EQ(parseParameter(ias, "boundary", "2.5").value(), 2.5);
    EXPECT_EQ(parseParameter(ias, "boundary-rule", "length").value(), 1.0);
    EXPECT_EQ(parseParameter(ias, "remove-instances", "off").value(), 0.0);
    EXPECT_EQ(parseParameter(ias, "remove-instances", "true").value(), 1.0);
}

TEST(Algorithms, WrongParametersAreUsageErrorsThatNameThem) {
    const Algorithm& ias = *findAlgorithm("ias");
    const std::vector<std::pair<std::string, std::string>> wrong{{"boundary", "-1"},
                                                                 {"boundary", "101"},
                                                                 {"boundary", "nan"},
                                                                 {"boundary", "1x"},
                                                                 {"boundary", ""},
                                                                 {"boundary", "inf"},
                                                                 {"boundary-rule", "width"},
                                                                 {"boundary-rule", "1"},
                                                                 {"remove-instances", "maybe"},
                                                                 {"flip-angle", "500"},
                                                                 {"no-such-parameter", "1"},
                                                                 {"", "1"}};
    for (const auto& [id, text] : wrong) {
        const Result<double> value = parseParameter(ias, id, text);
        ASSERT_FALSE(value) << id << "=" << text;
        EXPECT_EQ(value.error().kind, ErrorKind::Usage);
        EXPECT_NE(value.error().message.find("'" + id + "'"), std::string::npos);
    }
}

TEST(Algorithms, ValuesOutOfRangeAreUsageErrorsOfPrepare) {
    const ScenePtr scene = fixtures::gridScene(4);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Algorithm& algorithm : algorithms())
        for (const ParameterValues& values : {ParameterValues{{"boundary", -1.0}},
                                              {{"flip-angle", 1e9}},
                                              {{"boundary", nan}},
                                              {{"boundary-rule", 2.0}},
                                              {{"unheard-of", 1.0}}}) {
            const Result<LodSourcePtr> source = algorithm.prepare(scene, values, {}, {});
            ASSERT_FALSE(source) << algorithm.id << " " << values.begin()->first;
            EXPECT_EQ(source.error().kind, ErrorKind::Usage);
            EXPECT_NE(source.error().message.find(values.begin()->first), std::string::npos);
        }
}

TEST(Algorithms, ReachTheirTargetsOnEveryAssetClass) {
    for (const ScenePtr& scene : assetClasses())
        for (const Algorithm& algorithm : algorithms()) {
            const LodSourcePtr source = prepared(algorithm, scene);
            const ByteModel bytes(source->scene(), {});
            EXPECT_EQ(source->trianglesAt(0), countScene(*scene).triangles);
            const Resolved resolved = source->resolve({Target::Kind::Ratio, 0.5}, bytes);
            const Lod lod = source->readOut(resolved.position, nullptr);
            EXPECT_TRUE(resolved.met || lod.triangles <= 60) << algorithm.id << " " << scene->name;
        }
}

TEST(Algorithms, ExportsWeighWhatWasPredicted) {
    const ExportFolder folder;
    for (const ScenePtr& scene : assetClasses())
        for (const Algorithm& algorithm : algorithms()) {
            const LodSourcePtr source = prepared(algorithm, scene);
            const ByteModel bytes(source->scene(), {});
            for (const double ratio : kRatios) {
                const std::uint64_t position =
                    source->resolve({Target::Kind::Ratio, ratio}, bytes).position;
                const Lod lod = source->readOut(position, nullptr);
                EXPECT_EQ(folder.exported(*source->scene(), lod).size(),
                          bytes.bytes(source->shapeAt(position)))
                    << algorithm.id << " " << scene->name << " at " << ratio;
            }
        }
}

TEST(Algorithms, FilesGetStrictlySmallerWithEveryRemovedTriangle) {
    for (const ScenePtr& scene : assetClasses())
        for (const Algorithm& algorithm : algorithms()) {
            if (algorithm.family != Family::EdgeCollapse)
                continue; // one-shot methods merge anew for every value of their parameter
            const LodSourcePtr source = prepared(algorithm, scene);
            const ByteModel bytes(source->scene(), {});
            std::uint64_t size = bytes.bytes(source->shapeAt(0));
            std::uint32_t rises = 0;
            for (std::uint64_t p = 1; p < source->positionCount(); ++p) {
                if (source->trianglesAt(p) == source->trianglesAt(p - 1))
                    continue;
                const std::uint64_t next = bytes.bytes(source->shapeAt(p));
                rises += next >= size ? 1 : 0;
                size = next;
            }
            EXPECT_EQ(rises, 0u) << algorithm.id << " " << scene->name;
        }
}

TEST(Algorithms, GiveTheSameBytesOnAnyNumberOfThreads) {
    const ExportFolder folder;
    const ScenePtr scene =
        meshes::sceneOf({submeshOf({meshes::sphere(60, 80), meshes::soup(300)}),
                         submeshOf({meshes::torus(40, 20)})},
                        {meshes::gridOfTransforms(4, 4.0), meshes::gridOfTransforms(3, 9.0)});
    for (const Algorithm& algorithm : algorithms()) {
        std::set<std::string> files;
        for (const std::size_t threads : {1, 2, 8}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            const LodSourcePtr source = prepared(algorithm, scene);
            const ByteModel bytes(source->scene(), {});
            const std::uint64_t position =
                source->resolve({Target::Kind::Ratio, 0.2}, bytes).position;
            files.insert(folder.exported(*source->scene(), source->readOut(position, nullptr)));
        }
        EXPECT_EQ(files.size(), 1u) << algorithm.id;
    }
}

TEST(Algorithms, CancelledOnesReturnSoonAndNothing) {
    const ScenePtr scene =
        meshes::sceneOf({submeshOf({meshes::sphere(300, 400)})}, {{glm::dmat4(1.0)}});
    for (const Algorithm& algorithm : algorithms()) {
        std::stop_source source;
        JobContext job;
        job.stop = source.get_token();
        std::clock_t stopped = 0; // CPU time of all threads
        std::thread stopper([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(30));
            stopped = std::clock();
            source.request_stop();
        });
        const Result<LodSourcePtr> result = algorithm.prepare(scene, {}, {}, job);
        const std::clock_t ended = std::clock();
        stopper.join();
        ASSERT_FALSE(result) << algorithm.id;
        EXPECT_EQ(result.error().kind, ErrorKind::Cancelled);
        // 10 ms is the aim; sanitizers take their time, what else the machine does stays out of it.
        EXPECT_LT(static_cast<double>(ended - stopped) / CLOCKS_PER_SEC, 0.25) << algorithm.id;
    }
}

TEST(Algorithms, CancelledBeforeTheStartDoNothing) {
    std::stop_source source;
    source.request_stop();
    JobContext job;
    job.stop = source.get_token();
    for (const Algorithm& algorithm : algorithms()) {
        const Result<LodSourcePtr> result = algorithm.prepare(fixtures::gridScene(30), {}, {}, job);
        ASSERT_FALSE(result) << algorithm.id;
        EXPECT_EQ(result.error().kind, ErrorKind::Cancelled);
    }
}

TEST(Algorithms, ErrorEstimatesAreInTheWorldsUnits) {
    const glm::dmat4 small(glm::dmat3(0.001));
    const ScenePtr scene =
        meshes::sceneOf({submeshOf({meshes::sphere(12, 16)}), submeshOf({meshes::grid(1)})},
                        {{small}, {glm::dmat4(1.0)}});
    for (const Algorithm& algorithm : algorithms()) {
        const LodSourcePtr source = prepared(algorithm, scene);
        EXPECT_LT(source->errorAt(source->positionCount() - 1), 1.0) << algorithm.id;
    }
}

} // namespace lodestone
