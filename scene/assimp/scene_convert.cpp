#include "scene/assimp/scene_convert.h"

#include "scene/assimp/fold_equal.h"
#include "scene/assimp/material_convert.h"
#include "scene/assimp/mesh_convert.h"
#include "scene/finite.h"

#include <algorithm>
#include <assimp/scene.h>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

namespace lodestone {

namespace {

constexpr std::size_t kMaxNodes = 10'000'000;

glm::dmat4 toMatrix(const aiMatrix4x4& from) {
    glm::dmat4 to;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            to[column][row] = from[static_cast<unsigned>(row)][static_cast<unsigned>(column)];
    return to;
}

glm::dvec3 toVector(const aiVector3D& from) {
    return {from.x, from.y, from.z};
}

// Where a camera sits in its node: glTF's looks along -z with +y up.
glm::dmat4 placeInNode(const aiCamera& camera) {
    const glm::dvec3 position = toVector(camera.mPosition);
    const glm::dvec3 forward = toVector(camera.mLookAt);
    glm::dvec3 up = toVector(camera.mUp);
    if (!(glm::length(forward) > 0.0))
        return glm::translate(glm::dmat4(1.0), position);
    if (!(glm::length(glm::cross(forward, up)) > 1e-9 * glm::length(forward)))
        up = std::abs(forward.y) < 0.9 * glm::length(forward) ? glm::dvec3(0, 1, 0)
                                                              : glm::dvec3(0, 0, 1);
    return glm::inverse(glm::lookAt(position, position + forward, up));
}

Camera toCamera(const aiCamera& from) {
    Camera to;
    to.name = from.mName.C_Str();
    const double aspect = from.mAspect > 0.0f ? from.mAspect : 4.0 / 3.0;
    to.perspective = !(from.mOrthographicWidth > 0.0f);
    to.xmag = to.perspective ? 1.0 : from.mOrthographicWidth;
    to.ymag = to.xmag / aspect;
    const double xfov_rad = from.mHorizontalFOV;
    if (xfov_rad > 0.01 && xfov_rad < 3.1)
        to.yfov_rad = 2.0 * std::atan(std::tan(0.5 * xfov_rad) / aspect);
    if (from.mClipPlaneNear > 0.0f && std::isfinite(from.mClipPlaneNear))
        to.znear = from.mClipPlaneNear;
    if (from.mClipPlaneFar > from.mClipPlaneNear && std::isfinite(from.mClipPlaneFar))
        to.zfar = from.mClipPlaneFar;
    return to;
}

class SceneConverter {
public:
    SceneConverter(const aiScene& scene, const SourceFile& file, const JobContext& job)
        : scene_(scene), file_(file), job_(job), file_name_(file.path.filename().string()),
          builder_(file_name_), materials_(scene, file.path.parent_path(), builder_) {}

    Result<ScenePtr> convert();

private:
    struct Visit {
        const aiNode* from = nullptr;
        std::uint32_t parent = kNone;
    };

    Result<void> collectNodes();
    Result<void> convertMeshes();
    Result<void> makeSubmeshes();
    Result<void> addNode(const Visit& visit);
    void addCameras(const aiNode& from, std::uint32_t node);
    void addNotes();
    glm::dmat4 fileTransform() const;

    const aiScene& scene_;
    const SourceFile& file_;
    const JobContext& job_;
    std::string file_name_;
    SceneBuilder builder_;
    MaterialConverter materials_;
    std::vector<std::vector<Primitive>> mesh_primitives_;            // [scene_.mNumMeshes]
    std::vector<const aiNode*> nodes_;                               // parents first
    std::map<std::vector<std::uint32_t>, std::uint32_t> submesh_of_; // by set of meshes
    std::map<const aiNode*, std::uint32_t> node_of_;
};

// Flattens the tree without recursion: a file may nest it deeply.
Result<void> SceneConverter::collectNodes() {
    std::vector<const aiNode*> open{scene_.mRootNode};
    while (!open.empty()) {
        const aiNode* node = open.back();
        open.pop_back();
        if (node == nullptr)
            continue;
        nodes_.push_back(node);
        if (nodes_.size() > kMaxNodes)
            return badInput(file_name_ + ": has more than 10 million nodes; split the scene");
        for (unsigned child = node->mNumChildren; child > 0; --child)
            open.push_back(node->mChildren[child - 1]);
    }
    return {};
}

Result<void> SceneConverter::convertMeshes() {
    MeshOptions options;
    options.keep_normals = file_.extension != ".stl"; // its facet normals follow from the triangles
    for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
        if (job_.stopRequested())
            return cancelled();
        const aiMesh& mesh = *scene_.mMeshes[m];
        std::uint32_t texcoord_sets = 0;
        for (unsigned set = 0; set < AI_MAX_NUMBER_OF_TEXTURECOORDS; ++set)
            texcoord_sets += mesh.HasTextureCoords(set) ? 1 : 0;
        Result<std::vector<Primitive>> primitives =
            convertMesh(mesh, options, [&](std::uint32_t material) {
                return materials_.material(material, texcoord_sets);
            });
        if (!primitives)
            return badInput(file_name_ + ": mesh '" + mesh.mName.C_Str() +
                            "': " + primitives.error().message);
        mesh_primitives_.push_back(std::move(*primitives));
        job_.report(0.7 + 0.25 * (m + 1.0) / scene_.mNumMeshes);
    }
    return {};
}

// One submesh for every set of meshes that some node draws; equal ones become one.
Result<void> SceneConverter::makeSubmeshes() {
    std::vector<Submesh> submeshes;
    std::vector<std::vector<std::uint32_t>> keys;
    for (const aiNode* node : nodes_) {
        const std::vector<std::uint32_t> key(node->mMeshes, node->mMeshes + node->mNumMeshes);
        if (key.empty() || !submesh_of_.try_emplace(key, 0).second)
            continue;
        Submesh submesh;
        for (const std::uint32_t mesh : key) {
            if (mesh >= mesh_primitives_.size())
                return badInput(file_name_ + ": node '" + node->mName.C_Str() +
                                "' refers to a mesh that does not exist; export the file again");
            if (submesh.name.empty())
                submesh.name = scene_.mMeshes[mesh]->mName.C_Str();
            submesh.primitives.insert(submesh.primitives.end(),
                                      mesh_primitives_[mesh].begin(),
                                      mesh_primitives_[mesh].end());
        }
        submeshes.push_back(std::move(submesh));
        keys.push_back(key);
    }
    const std::vector<std::uint32_t> representative = findEqualSubmeshes(submeshes);
    std::vector<std::uint32_t> added(submeshes.size(), kNone);
    std::size_t folded_count = 0;
    for (std::uint32_t s = 0; s < submeshes.size(); ++s) {
        const bool drawable = !submeshes[s].primitives.empty();
        if (representative[s] != s) {
            added[s] = added[representative[s]];
            folded_count += drawable ? 1 : 0;
        } else if (drawable) {
            added[s] = builder_.addSubmesh(std::move(submeshes[s]));
        }
        submesh_of_[keys[s]] = added[s];
    }
    if (folded_count > 0)
        builder_.addNote(std::to_string(folded_count) +
                         " meshes equal others to the byte: drawn as instances of them");
    return {};
}

// What turns the file's axes and unit into glTF's where assimp leaves that to us.
glm::dmat4 SceneConverter::fileTransform() const {
    double centimetres = 0.0;
    if (file_.extension == ".fbx" && scene_.mMetaData != nullptr) {
        float value = 0.0f;
        if (scene_.mMetaData->Get("UnitScaleFactor", centimetres) ||
            (scene_.mMetaData->Get("UnitScaleFactor", value)))
            centimetres = centimetres > 0.0 ? centimetres : value;
    }
    if (!(centimetres > 0.0) || !std::isfinite(centimetres))
        return glm::dmat4(1.0);
    return glm::scale(glm::dmat4(1.0), glm::dvec3(0.01 * centimetres));
}

Result<void> SceneConverter::addNode(const Visit& visit) {
    const aiNode& from = *visit.from;
    glm::dmat4 local = toMatrix(from.mTransformation);
    if (visit.parent == kNone)
        local = fileTransform() * local;
    if (!isFinite(local))
        return badInput(file_name_ + ": the transform of node '" + from.mName.C_Str() +
                        "' is not finite; repair the scene and export again");
    const std::vector<std::uint32_t> key(from.mMeshes, from.mMeshes + from.mNumMeshes);
    const std::uint32_t submesh = key.empty() ? kNone : submesh_of_.at(key);
    const std::uint32_t node = builder_.addNode(from.mName.C_Str(), visit.parent, local, submesh);
    if (!isFinite(builder_.node(node).world))
        return badInput(file_name_ + ": the world transform of node '" + from.mName.C_Str() +
                        "' is not finite; repair the scene and export again");
    node_of_[visit.from] = node;
    return {};
}

void SceneConverter::addCameras(const aiNode& from, std::uint32_t node) {
    for (unsigned c = 0; c < scene_.mNumCameras; ++c) {
        const aiCamera& camera = *scene_.mCameras[c];
        if (camera.mName != from.mName)
            continue;
        const glm::dmat4 local = placeInNode(camera);
        if (isFinite(local))
            builder_.addCamera(toCamera(camera),
                               builder_.addNode(camera.mName.C_Str(), node, local));
    }
}

void SceneConverter::addNotes() {
    const auto note = [&](std::size_t count, const char* what) {
        if (count > 0)
            builder_.addNote("left out: " + std::to_string(count) + " " + what +
                             (count == 1 ? "" : "s"));
    };
    std::size_t skinned = 0;
    std::size_t morphed = 0;
    for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
        skinned += scene_.mMeshes[m]->HasBones() ? 1 : 0;
        morphed += scene_.mMeshes[m]->mNumAnimMeshes > 0 ? 1 : 0;
    }
    note(scene_.mNumLights, "light");
    note(scene_.mNumAnimations, "animation");
    note(skinned, "skin");
    note(morphed, "set of morph targets");
}

Result<ScenePtr> SceneConverter::convert() {
    Result<void> ok = collectNodes();
    if (ok)
        ok = convertMeshes();
    if (ok)
        ok = makeSubmeshes();
    if (!ok)
        return tl::unexpected(ok.error());
    for (const aiNode* from : nodes_) {
        const auto parent = node_of_.find(from->mParent);
        ok = addNode({from, parent == node_of_.end() ? kNone : parent->second});
        if (!ok)
            return tl::unexpected(ok.error());
        addCameras(*from, node_of_.at(from));
    }
    addNotes();
    builder_.setFileBytes(file_.bytes + materials_.imageFileBytes());
    ScenePtr scene = builder_.finish();
    if (scene->instances.empty())
        return badInput(file_name_ + ": holds nothing to draw; choose a file with a mesh");
    job_.report(1.0);
    return scene;
}

} // namespace

Result<ScenePtr> convertScene(const aiScene& scene, const SourceFile& file, const JobContext& job) {
    if (scene.mRootNode == nullptr)
        return badInput(file.path.filename().string() +
                        ": holds nothing to draw; choose a file with a mesh");
    return SceneConverter(scene, file, job).convert();
}

} // namespace lodestone
