fn $name($parameters) -> $result {
    $declare
    if (params.len_of_$nodes == 0u || !$is_finite(ray)) {
        return $give;
    }
    var stack: array<vec2<u32>, $STACK>;
    var top = 0u;
    var node = ${nodes}_at($first);
    let s = $slabs(ray, node.corner, node.corner + 255.0 * $cells(node.exponents), $slack, 0.0);
    // Slots in the order in which the ray is likely to enter them: `i ^ octant` for i from 0 on.
    let backward = select(vec3<u32>(0u), vec3<u32>(1u, 2u, 4u), ray.direction < vec3<f32>(0.0));
    let octant = backward.x | backward.y | backward.z;
    loop {
        // In bits, the children that the ray enters, in its order (`slot ^ octant`): nodes, and above
        // them leaves.
        var found = 0u;
        let cells = $cells(node.exponents);
        for (var slot = 0u; slot < 8u; slot = slot + 1u) {
            // The planes of four boxes are bytes of a word.
            let is_second = slot > 3u;
            let x = select(node.x.xz, node.x.yw, is_second);
            let y = select(node.y.xz, node.y.yw, is_second);
            let z = select(node.z.xz, node.z.yw, is_second);
            let shift = vec3<u32>(8u * (slot & 3u));
            // CPUs, as of lavapipe, convert signed integers faster.
            let lower = vec3<i32>((vec3<u32>(x.x, y.x, z.x) >> shift) & vec3<u32>(255u));
            let upper = vec3<i32>((vec3<u32>(x.y, y.y, z.y) >> shift) & vec3<u32>(255u));
            let low = node.corner + vec3<f32>(lower) * cells;
            let high = node.corner + vec3<f32>(upper) * cells;
            let e = $enter_leave(s, low, high, ray.t_min, limit);
            let bits = ((node.slots >> slot) & 0x101u) << (slot ^ octant);
            found = found | select(0u, bits, e.x <= e.y);
        }
        let inner = found & 255u;
        var leaves = found >> 8u;
        while (leaves != 0u) {
            let slot = firstTrailingBit(leaves) ^ octant;
            leaves = leaves & (leaves - 1u);
            // The sum of the counts of the slots before.
            let before = node.counts & ((1u << (4u * slot)) - 1u);
            let pairs = (before & 0x0f0f0f0fu) + ((before >> 4u) & 0x0f0f0f0fu);
            let begin = node.first_leaf + ((pairs * 0x01010101u) >> 24u);
            let end = begin + ((node.counts >> (4u * slot)) & 15u);
            for (var i = begin; i < end; i = i + 1u) {
                $test
            }
        }
        // The children that are left of a node: the first of them all, and in bits those that the ray
        // enters and, above, all slots of nodes.
        var group = vec2<u32>(node.first_node, inner | (node.slots << 8u));
        if (inner == 0u) {
            if (top == 0u) {
                break;
            }
            top = top - 1u;
            group = stack[top];
        }
        let slot = firstTrailingBit(group.y) ^ octant;
        group.y = group.y & (group.y - 1u);
        if ((group.y & 255u) != 0u) {
            stack[top] = group;
            top = top + 1u;
        }
        node = ${nodes}_at(group.x + countOneBits((group.y >> 8u) & ((1u << slot) - 1u)));
    }
    return $give;
}
