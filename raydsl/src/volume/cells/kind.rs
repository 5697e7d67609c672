//! Kinds of cells, and their division into tetrahedra.

/// Kind of a cell, with its vertices numbered as VTK numbers them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CellKind {
    /// Four vertices. (`VTK_TETRA`, 10.)
    Tetrahedron,
    /// A quadrilateral, 0 to 3 around it, and an apex, 4. (`VTK_PYRAMID`, 14.)
    Pyramid,
    /// Two triangles, 0 to 2 and 3 to 5, the first joined to 3. (`VTK_WEDGE`, 13.)
    Wedge,
    /// Two quadrilaterals, 0 to 3 around the one and 4 to 7 around the other, the first joined to
    /// 4. (`VTK_HEXAHEDRON`, 12.)
    Hexahedron,
}

/// Faces of each kind, all seen from one side; a triangle repeats its last vertex.
const TETRAHEDRON: [[usize; 4]; 4] = [[0, 2, 1, 1], [0, 1, 3, 3], [1, 2, 3, 3], [2, 0, 3, 3]];
const PYRAMID: [[usize; 4]; 5] =
    [[0, 3, 2, 1], [0, 1, 4, 4], [1, 2, 4, 4], [2, 3, 4, 4], [3, 0, 4, 4]];
const WEDGE: [[usize; 4]; 5] =
    [[0, 2, 1, 1], [3, 4, 5, 5], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]];
const HEXAHEDRON: [[usize; 4]; 6] =
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

impl CellKind {
    /// Returns the number of its vertices: 4, 5, 6 or 8.
    pub const fn vertices(self) -> usize {
        match self {
            Self::Tetrahedron => 4,
            Self::Pyramid => 5,
            Self::Wedge => 6,
            Self::Hexahedron => 8,
        }
    }

    /// Returns the number of tetrahedra that it is divided into at most: 1, 2, 3 or 6.
    pub const fn tetrahedra(self) -> usize {
        match self {
            Self::Tetrahedron => 1,
            Self::Pyramid => 2,
            Self::Wedge => 3,
            Self::Hexahedron => 6,
        }
    }

    const fn faces(self) -> &'static [[usize; 4]] {
        match self {
            Self::Tetrahedron => &TETRAHEDRON,
            Self::Pyramid => &PYRAMID,
            Self::Wedge => &WEDGE,
            Self::Hexahedron => &HEXAHEDRON,
        }
    }
}

/// Calls `each` with the tetrahedra of a cell, all of one orientation; those with a vertex twice
/// are left out.
///
/// Every quadrilateral is divided from its vertex of lowest index, so both cells that share it have
/// the same diagonal, and the cell is the cone from its own lowest vertex to the faces that lack
/// it, whose diagonals are those of the other faces too. (The rule of lowest indices: Dompierre,
/// Labbé, Vallet and Camarero, "How to Subdivide Pyramids, Prisms, and Hexahedra into
/// Tetrahedra", International Meshing Roundtable 1999. The cone makes six tetrahedra of a
/// hexahedron where their tables sometimes have five.)
pub(super) fn divide(kind: CellKind, vertices: &[u32], mut each: impl FnMut([u32; 4])) {
    let Some(&apex) = vertices.iter().min() else { return };
    for face in kind.faces() {
        let ring = face.map(|i| vertices[i]);
        if ring.contains(&apex) {
            continue;
        }
        let first = (0..4).min_by_key(|i| ring[*i]).unwrap_or(0);
        let at = |i: usize| ring[(first + i) % 4];
        for triangle in [[at(0), at(1), at(2)], [at(0), at(2), at(3)]] {
            let [a, b, c] = triangle;
            if a != b && b != c && c != a {
                each([a, b, c, apex]);
            }
        }
    }
}
