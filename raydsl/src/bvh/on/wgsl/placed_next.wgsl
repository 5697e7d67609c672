/// The next primitive that the ray may hit at or before `limit`; ${NONE}u when none is left.
fn $name(w: ptr<function, $traversal_type>, limit: f32) -> NextPrimitive {
    loop {
        if ((*w).next < (*w).last) {
            let id = ${ids}_at((*w).next);
            (*w).next = (*w).next + 1u;
            if (id < ${IS_INSTANCE}u) {
                return NextPrimitive((*w).here.ray, id, (*w).here.first);
            }
            let index = id & ${number}u;
            let ray = $transform((*w).here.ray, ${places}_at(index).to_object);
            $enter(w, index, ray, limit);
        }
        // The next node on the stack that is not beyond the limit.
        var found = false;
        while ((*w).top > (*w).here.bottom && !found) {
            (*w).top = (*w).top - 1u;
            found = (*w).enters[(*w).top] <= limit;
        }
        if (!found) {
            if ((*w).level <= 1u) {
                break;
            }
            // Back to the group around.
            (*w).level = (*w).level - 1u;
            (*w).here = (*w).levels[(*w).level];
            let place = ${places}_at((*w).here.place);
            let root = ${nodes}_at(place.root);
            let s = $slabs((*w).here.ray, root.min, root.max, place.slack, place.origin);
            (*w).lower = s.lower;
            (*w).upper = s.upper;
            (*w).inverse = s.inverse;
            continue;
        }
        var node = ${nodes}_at((*w).nodes[(*w).top]);
        let s = Slabs((*w).lower, (*w).upper, (*w).inverse);
        // Down to a leaf, the nearer child first.
        while (node.count == 0u) {
            let left = ${nodes}_at(node.first);
            let right = ${nodes}_at(node.first + 1u);
            $child_count
            let l = $enter_leave(s, left.min, left.max, (*w).here.ray.t_min, limit);
            let r = $enter_leave(s, right.min, right.max, (*w).here.ray.t_min, limit);
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
    return NextPrimitive((*w).here.ray, ${NONE}u, 0u);
}
