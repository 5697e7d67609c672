/// The next primitive that the ray may meet at or before `limit`; ${NONE}u when none is left.
fn $name(w: ptr<function, Traversal>, t_min: f32, limit: f32) -> u32 {
    loop {
        if ((*w).next < (*w).last) {
            (*w).next = (*w).next + 1u;
            return ${ids}_at((*w).next - 1u);
        }
        // The next node on the stack that is not beyond the limit.
        var found = false;
        while ((*w).top > 0u && !found) {
            (*w).top = (*w).top - 1u;
            found = (*w).enters[(*w).top] <= limit;
        }
        if (!found) {
            break;
        }
        var node = ${nodes}_at((*w).nodes[(*w).top]);
        let s = Slabs((*w).lower, (*w).upper, (*w).inverse);
        // Down to a leaf, the nearer child first.
        while (node.count == 0u) {
            let left = ${nodes}_at(node.first);
            let right = ${nodes}_at(node.first + 1u);
            let l = $enter_leave(s, left.min, left.max, t_min, limit);
            let r = $enter_leave(s, right.min, right.max, t_min, limit);
            let hit_left = l.x <= l.y;
            let hit_right = r.x <= r.y;
            if (!hit_left && !hit_right) {
                break;
            }
            let left_first = hit_left && (!hit_right || l.x <= r.x);
            if (hit_left && hit_right) {
                (*w).nodes[(*w).top] = select(node.first, node.first + 1u, left_first);
                (*w).enters[(*w).top] = select(l.x, r.x, left_first);
                (*w).top = (*w).top + 1u;
            }
            if (left_first) { node = left; } else { node = right; }
        }
        (*w).next = node.first;
        (*w).last = node.first + node.count;
    }
    return ${NONE}u;
}
