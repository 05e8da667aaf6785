// vtkQuadricDecimation with volume preservation.
#include "bench/peers/peer.h"
#include "bench/timing.h"

#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>
#include <vtkVersion.h>

namespace lodestone::bench {

namespace {

void fill(vtkPolyData& data, const PeerMesh& mesh) {
    const vtkNew<vtkPoints> points;
    points->SetDataTypeToFloat();
    for (const glm::vec3& p : mesh.positions)
        points->InsertNextPoint(p.x, p.y, p.z);
    const vtkNew<vtkCellArray> triangles;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const vtkIdType corners[3] = {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
        triangles->InsertNextCell(3, corners);
    }
    data.SetPoints(points);
    data.SetPolys(triangles);
}

double simplify(const Job& job, PeerMesh& out) {
    const vtkNew<vtkPolyData> data;
    fill(*data, *job.mesh);
    const double kept =
        static_cast<double>(job.triangle_target) / static_cast<double>(job.mesh->triangleCount());
    const double start = cpuSeconds();
    const vtkNew<vtkQuadricDecimation> filter;
    filter->VolumePreservationOn();
    filter->SetInputData(data);
    filter->SetTargetReduction(1.0 - kept);
    filter->Update();
    const double seconds = cpuSeconds() - start;
    vtkPolyData* made = filter->GetOutput();
    for (vtkIdType point = 0; point < made->GetNumberOfPoints(); ++point) {
        const double* p = made->GetPoint(point);
        out.positions.emplace_back(p[0], p[1], p[2]);
    }
    const vtkNew<vtkIdList> corners;
    made->GetPolys()->InitTraversal();
    while (made->GetPolys()->GetNextCell(corners) != 0)
        for (vtkIdType c = 0; c < 3 && corners->GetNumberOfIds() == 3; ++c)
            out.indices.push_back(static_cast<std::uint32_t>(corners->GetId(c)));
    return seconds;
}

} // namespace

MeshPeer vtkQuadricPeer() {
    return oneByOne(std::string("VTK ") + vtkVersion::GetVTKVersion() + " QuadricDecimation",
                    Welding::Positions,
                    simplify);
}

} // namespace lodestone::bench
