fn $name($parameters) -> $result {
    $declare
    if (params.len_of_$nodes == 0u || !$is_finite(ray)) {
        return $give;
    }
    var stack: array<u32, $STACK>;
    $declare_enters
    var top = 0u;
    var node = ${nodes}_at($first);
    let s = $slabs(ray, node.min, node.max, $slack, 0.0);
    $root_count
    let root = $enter_leave(s, node.min, node.max, ray.t_min, limit);
    if (!(root.x <= root.y)) {
        return $give;
    }
    loop {
        if (node.count > 0u) {
            for (var i = node.first; i < node.first + node.count; i = i + 1u) {
                let id = ${indices}_at(i);
                $test
            }
        } else {
            let left = ${nodes}_at(node.first);
            let right = ${nodes}_at(node.first + 1u);
            $child_count
            let l = $enter_leave(s, left.min, left.max, ray.t_min, limit);
            let r = $enter_leave(s, right.min, right.max, ray.t_min, limit);
            let hit_left = l.x <= l.y;
            let hit_right = r.x <= r.y;
            if (hit_left && hit_right) {
                let left_first = l.x <= r.x;
                stack[top] = select(node.first, node.first + 1u, left_first);
                $push_enter
                top = top + 1u;
                if (left_first) { node = left; } else { node = right; }
                continue;
            }
            if (hit_left) { node = left; continue; }
            if (hit_right) { node = right; continue; }
        }
        $pop
        node = ${nodes}_at(stack[top]);
    }
    return $give;
}
