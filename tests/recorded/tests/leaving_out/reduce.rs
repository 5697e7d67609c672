//! Makes a generated text smaller, edit by edit, until a judge refuses every further one.
//!
//! Edits are: a block of statements, a struct or a function deleted; a branch or a loop replaced by one
//! of its bodies; up to eight statements in a row deleted; a parameter or a member deleted with its
//! arguments. Nothing is known of what the text means: the judge has naga refuse what is no program.
//! Expressions stay whole: without operands that guard what no input of a judge has, a text is smaller
//! than anybody would write it.

/// A text by its lines: each is one statement, one member, or the head or the end of a block.
type Lines = Vec<String>;

/// The edits of one kind that begin at a line, the largest first.
type Edits = fn(&[String], usize) -> Vec<Lines>;

/// Returns what is left of a text after all edits that `is_same` accepts.
pub(super) fn reduce(text: &str, is_same: &mut dyn FnMut(&str) -> bool) -> String {
    let mut lines = lines_of(text);
    let kinds: [Edits; 4] = [blocks, bodies, runs, parameters];
    loop {
        let before = lines.clone();
        for edits in kinds {
            let mut at = lines.len();
            while at > 0 {
                at -= 1;
                while at < lines.len() {
                    let mut all = edits(&lines, at).into_iter();
                    let Some(next) = all.find(|next| is_same(&indented(next))) else { break };
                    lines = next;
                }
                at = at.min(lines.len());
            }
        }
        if lines == before {
            return indented(&lines);
        }
    }
}

/// Returns the lines of a text, without comments; what stands in one line has one each.
fn lines_of(text: &str) -> Lines {
    let code = text.lines().map(|line| line.split("//").next().unwrap_or("").trim());
    let split = |line: &str| match line.starts_with("if (") && line.ends_with('}') {
        true => line.replace(" { ", " {\n").replace("; ", ";\n").replace(" }", "\n}"),
        false => line.to_owned(),
    };
    let lines: Vec<String> = code.map(split).collect();
    let lines = lines.iter().flat_map(|line| line.lines());
    lines.filter(|line| !line.is_empty()).map(str::to_owned).collect()
}

/// Returns a text with an indentation, and an empty line after each block.
fn indented(lines: &[String]) -> String {
    let (mut text, mut depth) = (String::new(), 0usize);
    for line in lines {
        depth -= usize::from(line.starts_with('}'));
        text += &format!("{}{line}\n", "    ".repeat(depth));
        depth += usize::from(line.ends_with('{'));
        if depth == 0 && line == "}" {
            text.push('\n');
        }
    }
    text.trim_end().to_owned() + "\n"
}

/// Returns the lines at which the bodies of a block end, one for each arm of a branch.
fn ends_of(lines: &[String], at: usize) -> Vec<usize> {
    let (mut depth, mut ends) = (0usize, Vec::new());
    if !lines[at].ends_with('{') || lines[at].starts_with('}') {
        return ends;
    }
    for (i, line) in lines.iter().enumerate().skip(at) {
        if line.starts_with('}') {
            depth -= 1;
            if depth == 0 {
                ends.push(i);
            }
        }
        depth += usize::from(line.ends_with('{'));
        if depth == 0 {
            break;
        }
    }
    ends
}

fn end_of(lines: &[String], at: usize) -> Option<usize> {
    ends_of(lines, at).last().copied()
}

/// Returns the lines with others in place of those from `at` to `end`.
fn replaced(lines: &[String], at: usize, end: usize, by: &[String]) -> Lines {
    [&lines[..at], by, &lines[end + 1..]].concat()
}

fn blocks(lines: &[String], at: usize) -> Vec<Lines> {
    end_of(lines, at).map(|end| replaced(lines, at, end, &[])).into_iter().collect()
}

fn bodies(lines: &[String], at: usize) -> Vec<Lines> {
    let ends = ends_of(lines, at);
    let (Some(end), false) = (ends.last(), lines[at].starts_with("fn ")) else { return Vec::new() };
    let heads = [at].into_iter().chain(ends.iter().copied());
    let mut edits: Vec<Lines> =
        heads.zip(&ends).map(|(a, b)| replaced(lines, at, *end, &lines[a + 1..*b])).collect();
    if ends.len() > 1 {
        // Without its last arm.
        edits.push(replaced(lines, ends[ends.len() - 2], *end, &["}".to_owned()]));
    }
    edits
}

fn runs(lines: &[String], at: usize) -> Vec<Lines> {
    let is_plain = |line: &&String| !line.ends_with('{') && !line.starts_with('}');
    let most = lines[at..].iter().take(8).take_while(is_plain).count();
    let counts = [8, 4, 2, 1].into_iter().filter(|count| *count <= most);
    counts.map(|count| replaced(lines, at, at + count - 1, &[])).collect()
}

/// Returns the parts of a text between separators that are in no brackets.
fn parts<'a>(text: &'a str, separator: &str) -> Vec<&'a str> {
    let (mut depth, mut begin, mut all) = (0i32, 0, Vec::new());
    for (i, letter) in text.char_indices() {
        depth += i32::from(letter == '(') - i32::from(letter == ')');
        if depth == 0 && i >= begin && text[i..].starts_with(separator) {
            all.push(&text[begin..i]);
            begin = i + separator.len();
        }
    }
    all.push(&text[begin..]);
    all
}

/// Returns the text inside the bracket that opens at `open`.
fn inside(line: &str, open: usize) -> Option<&str> {
    let rest = &line[open + 1..];
    let mut depth = 1;
    rest.char_indices().find_map(|(i, letter)| {
        depth += i32::from(letter == '(') - i32::from(letter == ')');
        (depth == 0).then(|| &rest[..i])
    })
}

fn is_of_name(letter: char) -> bool {
    letter.is_alphanumeric() || "_<>".contains(letter)
}

/// Returns where the name before a bracket begins.
fn name_before(line: &str, open: usize) -> usize {
    line[..open].rfind(|letter| !is_of_name(letter)).map_or(0, |i| i + 1)
}

/// Deletes a part of each list of arguments of `name`.
fn without_argument(line: &str, name: &str, which: usize) -> String {
    let mut line = line.to_owned();
    let call = format!("{name}(");
    let calls: Vec<usize> = line.match_indices(&call).map(|(i, _)| i).collect();
    for begin in calls.into_iter().rev() {
        let open = begin + name.len();
        let Some(list) = inside(&line, open).filter(|_| name_before(&line, open) == begin) else {
            continue;
        };
        let mut arguments = parts(list, ", ");
        if which < arguments.len() {
            arguments.remove(which);
            let (end, rest) = (open + 1 + list.len(), arguments.join(", "));
            line.replace_range(open + 1..end, &rest);
        }
    }
    line
}

fn parameters(lines: &[String], at: usize) -> Vec<Lines> {
    let everywhere = |lines: &[String], name: &str, which: usize| -> Lines {
        lines.iter().map(|line| without_argument(line, name, which)).collect()
    };
    let of = |line: &str, word: &str| line.strip_prefix(word).map(str::to_owned);
    if let Some((name, _)) = of(&lines[at], "fn ").as_deref().and_then(|l| l.split_once('(')) {
        let list = inside(&lines[at], 3 + name.len()).unwrap_or("");
        let count = if list.is_empty() { 0 } else { parts(list, ", ").len() };
        return (0..count).map(|which| everywhere(lines, name, which)).collect();
    }
    if let Some(name) = of(&lines[at], "struct ").as_deref().and_then(|l| l.strip_suffix(" {")) {
        let end = end_of(lines, at).unwrap_or(at);
        let without = |member: usize| replaced(lines, member, member, &[]);
        let members = at + 1..end;
        return members.map(|m| everywhere(&without(m), name, m - at - 1)).collect();
    }
    Vec::new()
}

/// Of a text with one of each, all that its judge does not ask for is deleted.
#[test]
fn what_is_not_asked_for_goes() {
    let text = "struct A {\n    x: f32,\n    y: f32,\n}\n\nfn unused(a: f32) -> f32 {\n    return a;\n}\n\n\
                fn main(a: f32, b: f32) -> f32 {\n    // A remark.\n    let c = A(a, max(b, 1.0));\n    \
                var d: f32;\n    if (c.x > 0.0) { d = c.y; } else { d = a + 3.0; }\n    \
                while (d > 9.0) {\n        d = d - 1.0;\n    }\n    return d;\n}\n";
    let asked = ["struct A {", "y: f32", "fn main(", "b: f32", "max(b, 1.0)", "var d", "d = c.y;"];
    // A member and its argument go together, as naga has it.
    let mut is_asked = |text: &str| {
        text.contains("x: f32") == text.contains("A(a, ")
            && asked.iter().all(|word| text.contains(word))
            && text.contains("return d;")
    };
    let left = reduce(text, &mut is_asked);
    let known = "struct A {\n    y: f32,\n}\n\nfn main(b: f32) -> f32 {\n    let c = A(max(b, 1.0));\n    \
                 var d: f32;\n    d = c.y;\n    return d;\n}\n";
    assert_eq!(left, known);
}
