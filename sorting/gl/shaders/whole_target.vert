// SPDX-License-Identifier: BSD-3-Clause
// Draws one triangle that covers the viewport. The number of the instance is that of the column that is composited.
layout(location = 0) flat out int column;

void main() {
  column = gl_InstanceID;
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
