//! Texts of queries, and those of slices and of binary trees.

use super::TreeNames;
use crate::bvh::traverse::STACK;
use crate::machine::record::from_template;

/// Text fragments of a query.
#[derive(Clone, Copy)]
pub(super) struct Query<'a> {
    pub(super) result: &'a str,
    pub(super) declare: &'a str,
    /// Statement that lowers the limit of a traversal, beyond which nodes are culled.
    pub(super) lower: &'a str,
    /// Whether `best` may be a hit before the traversal.
    pub(super) continues: bool,
    /// Template with a line `$lower`, which only traversals have.
    pub(super) test: &'a str,
    pub(super) give: &'a str,
    pub(super) slack: f32,
    /// Whether node tests are counted, in `cost.nodes`.
    pub(super) counts: bool,
}

impl Query<'_> {
    /// Returns the declaration of a traversal's limit.
    pub(super) fn begin(&self) -> String {
        match (self.continues, self.lower) {
            (true, lower) => {
                format!("var limit = ray.t_max;\nif (best.is_hit) {{\n    {lower}\n}}")
            }
            (false, "") => "let limit = ray.t_max;".to_owned(),
            (false, _) => "var limit = ray.t_max;".to_owned(),
        }
    }

    /// Returns the statement that counts `n` node tests.
    fn count(&self, n: u32) -> String {
        if self.counts { format!("cost.nodes = cost.nodes + {n}u;") } else { String::new() }
    }
}

/// Returns a loop over all primitives.
pub(super) fn linear(name: &str, query: &Query<'_>, prims: &str, is_finite: &str) -> String {
    let Query { result, declare, test, give, .. } = query;
    from_template(
        include_str!("linear.wgsl"),
        &[
            ("name", name),
            ("result", result),
            ("declare", declare),
            ("test", &from_template(test, &[("lower", "")])),
            ("give", give),
            ("prims", prims),
            ("is_finite", is_finite),
        ],
    )
}

/// Takes the next node from the stack.
const POP: &str = "\
if (top == 0u) {
    break;
}
top = top - 1u;";

/// Takes the next node that is not beyond the limit from the stack.
const POP_WITHIN_LIMIT: &str = "\
// The next node on the stack that is not beyond the limit.
var found = false;
while (top > 0u && !found) {
    top = top - 1u;
    found = stack_t[top] <= limit;
}
if (!found) {
    break;
}";

/// Returns a depth-first traversal from the node `first`: it visits the nearer child first and
/// pushes the farther one, with its distance if the query has a limit that may come nearer.
pub(super) fn traverse(
    name: &str,
    parameters: &str,
    first: &str,
    query: &Query<'_>,
    tree: &TreeNames,
) -> String {
    let Query { result, declare, lower, test, give, slack, .. } = query;
    let TreeNames { nodes, indices, rules, boxes } = tree;
    // Where the limit stays, so does whether a node is entered: the stack needs no distances.
    let is_culled = !lower.is_empty();
    let of_culled = |text: &'static str| if is_culled { text } else { "" };
    let declare_enters =
        of_culled("var stack_t: array<f32, $STACK>;").replace("$STACK", &STACK.to_string());
    let pop = if is_culled { POP_WITHIN_LIMIT } else { POP };
    from_template(
        include_str!("traversal.wgsl"),
        &[
            ("declare_enters", &declare_enters),
            ("push_enter", of_culled("stack_t[top] = select(l.x, r.x, left_first);")),
            ("pop", pop),
            ("name", name),
            ("parameters", parameters),
            ("result", result),
            ("declare", &format!("{declare}\n{}", query.begin())),
            ("first", first),
            ("STACK", &STACK.to_string()),
            ("slack", &format!("{slack:?}")),
            ("test", &from_template(test, &[("lower", lower)])),
            ("give", give),
            ("root_count", &query.count(1)),
            ("child_count", &query.count(2)),
            ("nodes", nodes),
            ("indices", indices),
            ("is_finite", &rules.is_finite),
            ("slabs", &boxes.slabs),
            ("enter_leave", &boxes.enter_leave),
        ],
    )
}
