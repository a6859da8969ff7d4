// SPDX-License-Identifier: BSD-3-Clause
// A small mesh in three time steps: points with a scalar and a vector, cells with a number.
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const side = 9;

/** @param {number} step */
function mesh_text(step) {
  const points = [], pressure = [], velocity = [], cells = [], region = [];
  for (let k = 0; k <= side; ++k)
    for (let j = 0; j <= side; ++j)
      for (let i = 0; i <= side; ++i) {
        const [x, y, z] = [i, j, k].map((n) => n / side);
        points.push(`${2 * x} ${y} ${z}`);
        pressure.push((Math.sin(4 * x + step) * Math.cos(3 * y) + z).toFixed(6));
        velocity.push(`${(1 - y).toFixed(6)} ${(0.3 * Math.sin(6 * x)).toFixed(6)} ${(0.1 * step).toFixed(6)}`);
      }
  const at = (i, j, k) => (k * (side + 1) + j) * (side + 1) + i;
  for (let k = 0; k < side; ++k)
    for (let j = 0; j < side; ++j)
      for (let i = 0; i < side; ++i) {
        cells.push([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]].map(([a, b, c]) => at(i + a, j + b, k + c)).join(" "));
        region.push(1 + ((i + j + k) % 4));
      }
  const array = (name, type, components, lines) =>
    `<DataArray type="${type}" Name="${name}" NumberOfComponents="${components}" format="ascii">\n${lines.join("\n")}\n</DataArray>\n`;
  return `<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="${points.length}" NumberOfCells="${cells.length}">
<Points>${array("Points", "Float32", 3, points)}</Points>
<Cells>${array("connectivity", "Int64", 1, cells)}${array("offsets", "Int64", 1, cells.map((_, i) => 8 * (i + 1)))}${array("types", "UInt8", 1, cells.map(() => 12))}</Cells>
<PointData Scalars="pressure">${array("pressure", "Float64", 1, pressure)}${array("velocity", "Float64", 3, velocity)}</PointData>
<CellData>${array("region", "Float64", 1, region)}</CellData>
</Piece></UnstructuredGrid></VTKFile>
`;
}

/** Writes the series; the name of its .pvd. @param {string} folder */
export function write_flow_series(folder) {
  mkdirSync(folder, { recursive: true });
  const lines = [0, 1, 2].map((step) => {
    writeFileSync(join(folder, `flow_${step}.vtu`), mesh_text(step));
    return `<DataSet timestep="${step / 10}" file="flow_${step}.vtu"/>`;
  });
  const file = join(folder, "flow.pvd");
  writeFileSync(file, `<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1"><Collection>\n${lines.join("\n")}\n</Collection></VTKFile>\n`);
  return file;
}

/** Writes a mesh with a surface beside it, "inlet"; the name of the list of the two. @param {string} folder */
export function write_flow_with_inlet(folder) {
  write_flow_series(folder);
  writeFileSync(join(folder, "inlet.vtp"), `<?xml version="1.0"?>
<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData><Piece NumberOfPoints="3" NumberOfPolys="1">
<Points><DataArray type="Float32" Name="Points" NumberOfComponents="3" format="ascii">0 0 0 0 1 0 0 0 1</DataArray></Points>
<Polys><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2</DataArray><DataArray type="Int64" Name="offsets" format="ascii">3</DataArray></Polys>
</Piece></PolyData></VTKFile>
`);
  const file = join(folder, "flow.vtm");
  writeFileSync(file, `<?xml version="1.0"?>\n<VTKFile type="vtkMultiBlockDataSet" version="1.0"><vtkMultiBlockDataSet>
<DataSet index="0" name="fluid" file="flow_0.vtu"/><DataSet index="1" name="inlet" file="inlet.vtp"/>\n</vtkMultiBlockDataSet></VTKFile>\n`);
  return file;
}
