// The pose of a GPU scene.
#include "render/gpu_scene_state.h"

namespace lodestone {

void GpuSceneState::setMoment(const Moment& moment) {
    if (moment == moment_)
        return;
    moment_ = moment;
    const bool moved_before = !pose.texels.empty();
    uploadPose();
    if (moved_before || !pose.texels.empty())
        revision = renderer->nextRevision();
}

void GpuSceneState::uploadPose() {
    pose = packPose({*scene, *rig_, rest_, submeshes, frame}, moment_);
    if (pose.texels.empty())
        return;
    const bool first = !pose_texture;
    if (first) {
        pose_buffer_ = GlBuffer::create();
        pose_texture = GlTexture::create();
    }
    glBindBuffer(GL_TEXTURE_BUFFER, pose_buffer_.name());
    glBufferData(GL_TEXTURE_BUFFER,
                 static_cast<GLsizeiptr>(pose.texels.size() * sizeof(glm::vec4)),
                 pose.texels.data(),
                 GL_DYNAMIC_DRAW);
    glBindBuffer(GL_TEXTURE_BUFFER, 0);
    if (!first)
        return;
    glBindTexture(GL_TEXTURE_BUFFER, pose_texture.name());
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, pose_buffer_.name());
    glBindTexture(GL_TEXTURE_BUFFER, 0);
}

std::vector<glm::dvec3> GpuSceneState::posedPositions(const Geometry& geometry,
                                                      std::uint32_t instance) const {
    const Pose current = poseAt(*rig_, moment_);
    const InstancePose posed = instancePose(*scene, *rig_, rest_, current, instance);
    std::vector<glm::dmat4> joints;
    if (posed.skin != kNone)
        joints = jointMatrices(*rig_, current, posed.skin);
    return lodestone::posedPositions(geometry, posed, joints);
}

Mirroring GpuSceneState::mirroring(std::uint32_t submesh) const {
    return pose.submeshes[submesh].posed ? pose.submeshes[submesh].mirroring
                                         : submeshes[submesh].mirroring;
}

} // namespace lodestone
