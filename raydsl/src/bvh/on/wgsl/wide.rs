//! Queries of wide trees in WGSL.

use super::text::Query;
use super::{BoxTests, Described, Rules};
use crate::bvh::wide::cell_sizes;
use crate::bvh::wide::device::WideBuffer;
use crate::machine::record::from_template;
use crate::machine::{Machine, Recorder, U};

/// Names of the buffers of wide trees, and of the functions that their traversals call.
pub(super) struct WideNames {
    pub(super) nodes: String,
    pub(super) leaves: String,
    pub(super) ids: String,
    /// The roots of a list.
    pub(super) roots: Option<String>,
    /// Entries of a traversal's stack.
    stack: usize,
    rules: Rules,
    boxes: BoxTests,
    cells: String,
}

impl Recorder {
    /// Returns the buffers of wide trees; none if a tree is not wide.
    pub(super) fn wide(&self, prims: &dyn Described) -> Option<WideNames> {
        let buffers = prims.wide_buffers()?;
        let add = |buffer: &WideBuffer| {
            self.buffer(prims.key_of(buffer.part), &buffer.name, buffer.schema, buffer.len)
        };
        Some(WideNames {
            nodes: add(&buffers.nodes),
            leaves: add(&buffers.leaves),
            ids: add(&buffers.ids),
            roots: buffers.roots.as_ref().map(add),
            stack: buffers.stack,
            rules: self.rules(),
            boxes: self.box_tests(false),
            cells: self.name_of(|m| cell_sizes::on(m, U(m.u32(0)))),
        })
    }
}

impl WideNames {
    /// Returns a depth-first traversal from the node `first`. Of the children that a ray enters,
    /// leaves come first, and then the nodes in the order of their slots; the stack has, of each node
    /// on the way, the children that are left.
    pub(super) fn traverse(
        &self,
        name: &str,
        parameters: &str,
        first: &str,
        query: &Query<'_>,
    ) -> String {
        let Query { declare, lower, test, give, result, slack, counts, .. } = query;
        debug_assert!(!counts, "only the traversal of binary trees counts its work");
        from_template(
            include_str!("wide.wgsl"),
            &[
                ("name", name),
                ("parameters", parameters),
                ("result", result),
                ("declare", &format!("{declare}\n{}", query.begin())),
                ("give", give),
                ("nodes", &self.nodes),
                ("is_finite", &self.rules.is_finite),
                ("STACK", &self.stack.to_string()),
                ("first", first),
                ("slabs", &self.boxes.slabs),
                ("enter_leave", &self.boxes.enter_leave),
                ("cells", &self.cells),
                ("slack", &format!("{slack:?}")),
                ("test", &from_template(test, &[("lower", lower)])),
            ],
        )
    }
}
